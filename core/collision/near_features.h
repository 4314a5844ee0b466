// Narrow phase of method `scree`: the places where two bodies are close to each other, found while
// they are still apart. Corners of each against the surface of the other, and pairs of convex
// edges; each gives a point, a normal and a gap.  [A7, A8; algorithm 14]
//
// A gap, unlike an interference, is known before anything has gone wrong, and is a smooth function
// of the poses, so that one detection serves a whole step.
#pragma once

#include <cstdint>
#include <vector>

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

/// The features of a pair that may come within reach, remembered while the pair moves little. The
/// memory changes no result: what is found depends on the poses and the reach alone.
class NearFeatures {
public:
    /// Appends all contacts with gaps below `reach` [m], ordered by feature.
    void findContacts(const PlacedPair& pair, double reach, std::vector<GapContact>& contacts);

private:
    struct NearCorner {
        double atLeast;  // lower bound of its distance when looked at [m]
        std::int32_t corner;
    };
    struct NearEdges {
        double atLeast;
        std::int32_t ofA, ofB;
    };

    void lookAgain(const PlacedPair& pair, const Mat3& rotation, const Vec3& translation);

    bool isKnown_ = false;
    double clearance_ = 0.0;            // everything closer than this was noted [m]
    Mat3 rotation_ = Mat3::Identity();  // B from A when looked at
    Vec3 translation_ = Vec3::Zero();
    std::vector<NearCorner> cornersOfA_, cornersOfB_;
    std::vector<NearEdges> edges_;
};

}  // namespace scree
