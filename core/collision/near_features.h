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

#include <cstdint>
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
struct ToWorld;

/// The features of a pair that may come within reach, remembered while the pair moves little. The
/// memory changes no result: what is found depends on the poses and the reach alone.
///
/// Distances change no faster than points move. So for every feature there is a place on the way of
/// the pair (how far any point has moved in the frame of the other body, added up) before which it
/// need not be looked at; and for most pairs one for all of them. `odometer` is a bound of that
/// way that costs nothing: what the two bodies have moved in the world, added up [m].
class NearFeatures {
public:
    /// Whether nothing can be within reach; may say no too often.
    bool isApart(double reach, double odometer) const
    {
        return reach + (odometer - odometerThen_) < apart_;
    }

    /// Appends all contacts with gaps below `reach` [m], in an order of the shapes.
    void findContacts(const PlacedPair& pair, double reach, std::vector<GapContact>& contacts,
                      double odometer = 0.0);

private:
    struct NearCorner {
        double farUntil;  // its distance plus the way, when last looked at [m]
        std::int32_t corner;
    };
    struct NearEdges {
        double farUntil;
        double outsideUntil;  // place on the way until which they cannot have crossed [m]
        std::int32_t ofA, ofB;
    };

    void moveTo(const RelativePair& pair);
    bool isStale(double reach) const;
    void lookAgain(const RelativePair& pair, const RelativePair& back, double reach);
    void lookAtCorners(const RelativePair& pair, double clearance,
                       std::vector<NearCorner>& near) const;
    void lookAtEdges(const RelativePair& pair, const RelativePair& back, double reach);
    void touchEdges(const RelativePair& pair, const ToWorld& toWorld, double reach,
                    ContactList& list);

    bool isKnown_ = false;
    double apart_ = 0.0;  // distance of the bodies at odometerThen_; 0 if not known to be [m]
    double odometerThen_ = 0.0;         // [m]
    double way_ = 0.0;                  // [m]
    double lookedAt_ = 0.0;             // place on the way of the last look [m]
    double window_ = 0.0;               // the way for which that is good [m]
    double clearance_ = 0.0;            // everything nearer was noted then [m]
    Mat3 rotation_ = Mat3::Identity();  // B from A, when last moved to
    Vec3 translation_ = Vec3::Zero();
    std::vector<NearCorner> cornersOfA_, cornersOfB_;
    std::vector<NearEdges> edges_;
};

}  // namespace scree
