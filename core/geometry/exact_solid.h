// Solids whose distance is a formula: half space, sphere, box, cylinder. Distance, direction,
// curvature and mass are those of the true shape, not of a mesh.  [A9]
//
// All are convex and centred at their own origin, the cylinder about +y; the half space lies below
// y = 0. One struct of half extents serves all of them, so that a field can hold any by value.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "core/geometry/mass_properties.h"
#include "core/math/aabb.h"

namespace scree {

/// A face that passes close to a point, with the angle it spans there: half a turn, or the
/// corner's own angle at a corner [rad].
struct NearFace {
    Vec3 normal;
    double angle;
    double height;    ///< of the point above the face's plane [m]
    double distance;  ///< of the point from the face itself [m]
};

class ExactSolid {
public:
    enum class Form { plane, sphere, box, cylinder };

    /// Lengths must be > 0 [m].
    static ExactSolid plane() { return {Form::plane, Vec3::Zero()}; }
    static ExactSolid sphere(double radius) { return {Form::sphere, Vec3::Constant(radius)}; }
    static ExactSolid box(const Vec3& size) { return {Form::box, 0.5 * size}; }
    static ExactSolid cylinder(double radius, double height)
    {
        return {Form::cylinder, {radius, 0.5 * height, radius}};
    }

    Form form() const { return form_; }
    /// Half the edges of its box; of a cylinder (radius, half the height, radius) [m].
    const Vec3& half() const { return half_; }
    Aabb box() const;
    /// Of the smallest ball about the origin that holds it; not of a plane [m].
    double boundingRadius() const;
    /// Not of a plane. Axes stay the solid's own, so the moments come in their order, unsorted.
    MassProperties massProperties() const;

    /// Signed distance, negative inside [m].
    double value(const Vec3& point) const
    {
        switch (form_) {
            case Form::plane:
                return point.y();
            case Form::sphere:
                return point.norm() - half_.x();
            case Form::box:
                return beyond(point.cwiseAbs() - half_);
            case Form::cylinder:
                break;
        }
        const double across = std::sqrt(point.x() * point.x() + point.z() * point.z());
        const double side = across - half_.x(), cap = std::abs(point.y()) - half_.y();
        return beyond({side, cap, std::min(0.0, side)});
    }

    /// Unit gradient of the distance; where several directions are equally near, one of them.
    Vec3 gradient(const Vec3& point) const;

    /// ½ ∇·N of the face nearest to the point; at a rim it has no end [1/m].
    double meanCurvature(const Vec3& point) const;

    /// Where the way from `from` to `to`, begun `slack` earlier and ended as much later, enters the
    /// solid. Nothing when it does not, or begins inside. Not for planes.
    std::optional<Vec3> entry(const Vec3& from, const Vec3& to, double slack) const;

    /// Appends the faces that pass within `tolerance` of a point of the surface.
    void facesNear(const Vec3& point, double tolerance, std::vector<NearFace>& faces) const;

private:
    ExactSolid(Form form, const Vec3& half) : form_(form), half_(half) {}

    /// Distance to the corner of coordinates: `excess` is how far a point lies beyond each face.
    static double beyond(const Vec3& excess)
    {
        const double largest = std::max(excess.x(), std::max(excess.y(), excess.z()));
        if (largest <= 0.0) return largest;
        return excess.cwiseMax(0.0).norm();
    }

    Form form_;
    Vec3 half_;
};

}  // namespace scree
