// Two bodies as their features see each other: one at rest, the other somewhere before it; and what
// it means there to touch. All kinds of contacts are told in this frame, and turned into the world
// at the end.
#pragma once

#include <algorithm>

#include "core/geometry/shape.h"

namespace scree {

/// Two shapes in the frame of the second.
struct RelativePair {
    const Shape& first;
    const Shape& second;
    Mat3 rotation;     ///< second from first
    Vec3 translation;  ///< [m]

    RelativePair reversed() const
    {
        const Mat3 back = rotation.transpose();
        return {second, first, back, -(back * translation)};
    }
    Vec3 operator*(const Vec3& point) const { return rotation * point + translation; }
};

/// Bounding radius of the smaller shape [m]; planes have none.
double smallerRadius(const Shape& a, const Shape& b);

/// In the frame of the second shape.
struct FeatureContact {
    Vec3 point;   ///< on the first [m]
    Vec3 normal;  ///< out of the second
    double gap;   ///< [m]
};

/// Nearer to an edge or corner than this share of the smaller body, the faces beside it decide the
/// normal: an edge is no sharper than that.
inline constexpr double kSharpness = 1e-3;

/// The same as a length [m], where the thinner of the two is thin: the faces on the far side of a
/// sheet are not beside the edges of this one. Sheets of paper that lay on each other went through
/// each other.
inline double sharpnessOf(double smaller, double thickness)
{
    constexpr double kOfThickness = 0.2;
    return std::min(kSharpness * smaller, kOfThickness * thickness);
}

inline double sharpnessOf(const RelativePair& pair)
{
    return sharpnessOf(smallerRadius(pair.first, pair.second),
                       std::min(pair.first.commonThickness, pair.second.commonThickness));
}

/// Edges deeper in each other than this are not what touches [m]: in a deep overlap every far edge
/// "interferes", and the corners inside tell the way out. By what is thickest: a shard is thin at
/// its rim, and that sinks in deeper than it is thick in a step.
inline double deepestEdges(const RelativePair& pair)
{
    return 0.5 * std::min(pair.first.innerBall.radius, pair.second.innerBall.radius);
}

/// How far from the other body an edge may be and still be where a blade, an edge sharper than
/// kBlade, has sunk in: the edge it has crossed is outside then [m].
inline double reachOfBlades(const RelativePair& pair)
{
    const bool hasBlades = pair.first.features.hasBlades() || pair.second.features.hasBlades();
    return hasBlades ? deepestEdges(pair) : 0.0;
}

}  // namespace scree
