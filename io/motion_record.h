// How a body moves, as a fixed number of doubles: for the files that only we read back.
#pragma once

#include <algorithm>
#include <array>

#include "core/math/types.h"

namespace scree {

/// Position, orientation (x y z w), velocity, and what says how it turns: angular velocity or
/// momentum.
using MotionRecord = std::array<double, 13>;

inline MotionRecord motionRecord(const Vec3& position, const Quat& orientation,
                                 const Vec3& velocity, const Vec3& turning)
{
    MotionRecord record;
    double* end = std::copy_n(position.data(), 3, record.data());
    end = std::copy_n(orientation.coeffs().data(), 4, end);
    end = std::copy_n(velocity.data(), 3, end);
    std::copy_n(turning.data(), 3, end);
    return record;
}

inline void readMotion(const MotionRecord& record, Vec3& position, Quat& orientation,
                       Vec3& velocity, Vec3& turning)
{
    position = Eigen::Map<const Vec3>(record.data());
    orientation.coeffs() = Eigen::Map<const Eigen::Vector4d>(&record[3]);
    velocity = Eigen::Map<const Vec3>(&record[7]);
    turning = Eigen::Map<const Vec3>(&record[10]);
}

}  // namespace scree
