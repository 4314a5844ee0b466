// How one feature of a body faces another: a corner a surface, an edge an edge. Each
// answers a place, a normal and a gap, or nothing when the two are no contact.  [A7, A8]
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "core/geometry/shape.h"

namespace scree {

/// Nearer to an edge or corner than this share of the smaller body, the faces beside it decide the
/// normal: an edge is no sharper than that.
inline constexpr double kSharpness = 1e-3;

/// Edges closer to parallel than this meet nowhere in particular: their ends speak for them [-].
inline constexpr double kParallel = 1e-3;

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

/// Edges deeper in each other than this are not what touches [m]: in a deep overlap every far edge
/// "interferes", and the corners inside tell the way out.
inline double deepestEdges(const RelativePair& pair)
{
    return 0.25 * std::min(pair.first.innerThickness, pair.second.innerThickness);
}

/// Lines of edges that are closest past the ends of these by no more than so many times their
/// overlap may still be what touches, in the notch of a hollow outline.
inline constexpr double kPastEnds = 5.0;

/// In the frame of the second shape.
struct FeatureContact {
    Vec3 point;   ///< on the first [m]
    Vec3 normal;  ///< out of the second
    double gap;   ///< [m]
};

/// Bounding radius of the smaller shape [m]; planes have none.
double smallerRadius(const Shape& a, const Shape& b);

/// What a corner and a surface are to each other.
struct FacedCorner {
    std::optional<FeatureContact> contact;
    /// If not, as though it were one: the corner lies inside, but what surrounds it would have had
    /// to pass through the surface first.
    std::optional<FeatureContact> unsupported;
    double apart = 0.0, within = 0.0;  ///< if neither, their distance at least and at most [m]
};

/// A corner of the first shape and the surface of the second, which are in contact when nearer than
/// `reach`: only when they are, so that a corner known to be farther away need not be asked about.
FacedCorner faceCorner(const RelativePair& pair, std::int32_t corner, double reach,
                       double sharpness);

/// What two edges are to each other.
struct FacedEdges {
    std::optional<FeatureContact> contact;
    /// If not, as though they were one: they lie in each other, and the nearest places of their
    /// lines are past the end of one.
    std::optional<FeatureContact> unsupported;
};

/// An edge of either, when their gap is below `reach`.
FacedEdges faceEdges(const RelativePair& pair, std::int32_t ofFirst, std::int32_t ofSecond,
                     double reach, double sharpness);

}  // namespace scree
