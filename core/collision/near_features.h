// Narrow phase of method `scree`: the places where two bodies are close to each other, found while
// they are still apart. Corners of each against the surface of the other, and pairs of convex
// edges; each gives a point, a normal and a gap.  [A7, A8; algorithm 14]
//
// Which features those are is looked for and remembered in feature_memory.h; here they are asked.
// Where the features of a fine mesh stand for a round surface, the places of that surface take over
// (round_contacts.h).
//
// A gap, unlike an interference, is known before anything has gone wrong, and is a smooth function
// of the poses, so that one detection serves a whole step.
#pragma once

#include <memory>
#include <vector>

#include "core/collision/contact_with_gap.h"
#include "core/collision/placed_pair.h"

namespace scree {

class FeatureMemory;
struct RelativePair;

/// Lower bound of the distance between two bodies, from a few spheres around their features [m];
/// far below zero where these overlap.
double apartAtLeast(const PlacedPair& bodies);

/// The features of a pair that may come within reach, remembered while the pair moves little. The
/// memory changes no result: what is found depends on the poses and the reach alone. Most pairs
/// whose boxes meet are far apart and have none: with one each ten thousand rings took a seventh
/// more memory.
class NearFeatures {
public:
    NearFeatures();
    ~NearFeatures();
    NearFeatures(NearFeatures&&) noexcept;
    NearFeatures& operator=(NearFeatures&&) noexcept;

    /// Appends all contacts with gaps below `reach` [m], in an order of the shapes. Answers how far
    /// apart the bodies are at least: once the points of both have moved in the world by at most m,
    /// added up, there is no contact with a gap below that less m [m].
    double findContacts(const PlacedPair& pair, double reach, std::vector<GapContact>& contacts);

    /// Memories lie scattered: what is asked soon can be fetched beforehand, first what it is, then
    /// what it lists.
    void prefetch() const;
    void prefetchLists() const;

private:
    /// Looks at all features and remembers those that may come within reach, or nothing where all
    /// are far. Answers how far apart the bodies are at least [m].
    double look(const RelativePair& pair, const RelativePair& back, double reach);

    std::unique_ptr<FeatureMemory> memory_;  // none while everything is far
};

}  // namespace scree
