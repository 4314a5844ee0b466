#include "core/geometry/surface_curvature.h"

namespace scree {

double meanCurvature(const Shape& shape, const Vec3& point)
{
    if (const ExactSolid* solid = shape.distance.solid()) return solid->meanCurvature(point);
    // Whole cells apart: the places in them are the same, and slopes that are those of the cells'
    // middles differ as if they were those of the places.
    const double reach = 2.0 * shape.distance.spacing();
    double divergence = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = reach * Vec3::Unit(axis);
        const Vec3 ahead = shape.distance.cellGradient(point + step).normalized();
        const Vec3 behind = shape.distance.cellGradient(point - step).normalized();
        divergence += (ahead[axis] - behind[axis]) / (2.0 * reach);
    }
    return 0.5 * divergence;
}

}  // namespace scree
