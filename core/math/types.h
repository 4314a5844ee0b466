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
