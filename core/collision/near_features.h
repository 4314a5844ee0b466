// Narrow phase of method `scree`: the places where two bodies are close to each other, found while
// they are still apart. Corners of each against the surface of the other, and pairs of convex
// edges; each gives a point, a normal and a gap.  [A7, A8; algorithm 14]
//
// Where the features of a fine mesh stand for a round surface, the places of that surface take over
// (round_contacts.h).
//
// A gap, unlike an interference, is known before anything has gone wrong, and is a smooth function
// of the poses, so that one detection serves a whole step.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/collision/feature_contacts.h"
#include "core/collision/interference.h"
#include "core/geometry/shape.h"

namespace scree {

/// Two surfaces facing each other. The normal points from B to A.
struct GapContact {
    std::uint64_t feature;  ///< which features of A and B: the same as long as they stay the same
    Vec3 rA;      ///< the place, halfway between the surfaces, from A's centre of mass, world [m]
    Vec3 normal;  ///< world
    double gap;   ///< [m], negative when they overlap
};

/// Lower bound of the distance between two bodies, from a few spheres around their features [m];
/// far below zero where these overlap.
double apartAtLeast(const PlacedPair& bodies);

class ContactList;
enum class FeatureKind : std::uint64_t;
struct ToWorld;

/// The features of a pair that may come within reach, remembered while the pair moves little. The
/// memory changes no result: what is found depends on the poses and the reach alone.
///
/// Distances change no faster than points move. So for every feature there is a place on the way of
/// the pair (how far any point has moved in the frame of the other body, added up) before which it
/// need not be looked at; and for most pairs one for all of them.
class alignas(64) NearFeatures {
public:
    /// Appends all contacts with gaps below `reach` [m], in an order of the shapes. Answers how far
    /// apart the bodies are at least: once the points of both have moved in the world by at most m,
    /// added up, there is no contact with a gap below that less m [m].
    double findContacts(const PlacedPair& pair, double reach, std::vector<GapContact>& contacts);

    /// Memories lie scattered: what is asked soon can be fetched beforehand, first what it is, then
    /// what it lists.
    void prefetch() const;
    void prefetchLists() const;

private:
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();
    static constexpr FloatLanes kNever = {kInfinity, kInfinity, kInfinity, kInfinity,
                                          kInfinity, kInfinity, kInfinity, kInfinity};

    /// What is told eight at a time, in single precision, on the way since the last look [m]. Lanes
    /// that are left over are infinitely far.
    struct alignas(64) NearCorners {
        FloatLanes farUntil = kNever;  // how far they were when last looked at
        std::array<std::int32_t, kFloatLanes> corner = {};
    };
    struct alignas(64) NearEdges {
        FloatLanes farUntil = kNever;
        FloatLanes outsideUntil = kNever;  // the way until which they cannot have crossed
        std::array<std::int32_t, kFloatLanes> ofA = {}, ofB = {};
    };
    void moveTo(const RelativePair& pair);
    bool isStale(double reach) const;
    void lookAgain(const RelativePair& pair, const RelativePair& back, double reach,
                   std::vector<NearEdges>& found);
    void lookAtCorners(const RelativePair& pair, std::vector<NearCorners>& near) const;
    void lookAtEdges(const RelativePair& pair, const RelativePair& back, double reach,
                     std::vector<NearEdges>& found) const;
    void faceCorners(const RelativePair& pair, FeatureKind kind, const ToWorld& toWorld,
                     double reach, std::vector<NearCorners>& near, ContactList& list) const;
    void touchEdges(const RelativePair& pair, const ToWorld& toWorld, double reach,
                    std::vector<NearEdges>& near, ContactList& list) const;
    void keep(const std::vector<NearEdges>& found, double reach);

    bool isKnown_ = false;
    double moved_ = 0.0;                // the way since the last look [m]
    double window_ = 0.0;               // for which that is good [m]
    double clearance_ = 0.0;            // everything nearer was noted then [m]
    Mat3 rotation_ = Mat3::Identity();  // B from A, when last moved to
    Vec3 translation_ = Vec3::Zero();
    std::vector<NearCorners> cornersOfA_, cornersOfB_;
    std::vector<NearEdges> edges_;
};

}  // namespace scree
