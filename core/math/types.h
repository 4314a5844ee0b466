// Eigen under our names. Points are columns, so one point is contiguous.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace scree {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Quat = Eigen::Quaterniond;

using Points = Eigen::Matrix3Xd;     // 3×#V
using Triangles = Eigen::Matrix3Xi;  // 3×#F corner indices, counter-clockwise seen from outside

/// Texture coordinates (u, v) of every triangle's corners: 2×(3·#F), corner k of triangle f in
/// column 3f + k; v grows upwards. No columns: there are none. They belong to corners because along
/// a seam two triangles see the same point at different places of the picture. Single precision, as
/// every file has them: they are handed on, never computed with.
using CornerUvs = Eigen::Matrix2Xf;

/// A rigid placement: maps a point of the named source frame to the named target frame.
struct Pose {
    Vec3 position = Vec3::Zero();
    Quat orientation = Quat::Identity();

    Vec3 operator*(const Vec3& point) const { return orientation * point + position; }
};

/// targetFromMiddle * middleFromSource = targetFromSource.
inline Pose operator*(const Pose& targetFromMiddle, const Pose& middleFromSource)
{
    return {targetFromMiddle * middleFromSource.position,
            targetFromMiddle.orientation * middleFromSource.orientation};
}

inline Pose inverse(const Pose& pose)
{
    const Quat back = pose.orientation.conjugate();
    return {-(back * pose.position), back};
}

}  // namespace scree
