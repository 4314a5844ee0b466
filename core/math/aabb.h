// Axis-aligned boxes.
#pragma once

#include <limits>

#include "core/math/types.h"

namespace scree {

struct Aabb {
    Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 max = Vec3::Constant(-std::numeric_limits<double>::infinity());

    static Aabb everything() { return {-Aabb().min, -Aabb().max}; }

    Vec3 size() const { return max - min; }
    Vec3 centre() const { return 0.5 * (min + max); }
    double longestEdge() const { return size().maxCoeff(); }
    double shortestEdge() const { return size().minCoeff(); }
    double diagonal() const { return size().norm(); }
    bool isEmpty() const { return (min.array() > max.array()).any(); }

    void include(const Vec3& point)
    {
        min = min.cwiseMin(point);
        max = max.cwiseMax(point);
    }
    void include(const Aabb& other)
    {
        min = min.cwiseMin(other.min);
        max = max.cwiseMax(other.max);
    }
    Aabb grown(double margin) const
    {
        return {min - Vec3::Constant(margin), max + Vec3::Constant(margin)};
    }
    bool overlaps(const Aabb& other) const
    {
        bool meets = true;  // without a branch: of boxes nearby nobody can guess
        for (int k = 0; k < 3; ++k) meets &= (min[k] <= other.max[k]) & (other.min[k] <= max[k]);
        return meets;
    }
    bool contains(const Aabb& other) const
    {
        return (min.array() <= other.min.array()).all() && (other.max.array() <= max.array()).all();
    }
    /// Distance from a point to the box, 0 inside.
    double distanceTo(const Vec3& point) const
    {
        return (point - point.cwiseMax(min).cwiseMin(max)).norm();
    }
};

/// The axis-aligned box around a moved box.
inline Aabb transformed(const Aabb& box, const Mat3& rotation, const Vec3& position)
{
    const Vec3 centre = rotation * box.centre() + position;
    const Vec3 half = rotation.cwiseAbs() * (0.5 * box.size());
    return {centre - half, centre + half};
}

}  // namespace scree
