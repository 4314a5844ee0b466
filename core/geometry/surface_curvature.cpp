#include "core/geometry/surface_curvature.h"

namespace scree {
namespace {

/// ½ ∇·N by central differences over four cells. The places asked for are whole cells apart, so
/// they lie alike in their cells: gradients that are those of the cells' middles differ as if they
/// were those of the places.
template <class Gradient>
double halfDivergence(const Shape& shape, const Vec3& point, const Gradient& gradientAt)
{
    const double reach = 2.0 * shape.distance.spacing();
    double divergence = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 step = reach * Vec3::Unit(axis);
        const Vec3 ahead = gradientAt(point + step).normalized();
        const Vec3 behind = gradientAt(point - step).normalized();
        divergence += (ahead[axis] - behind[axis]) / (2.0 * reach);
    }
    return 0.5 * divergence;
}

}  // namespace

double meanCurvature(const Shape& shape, const Vec3& point)
{
    if (const ExactSolid* solid = shape.distance.solid()) return solid->meanCurvature(point);
    return halfDivergence(shape, point,
                          [&](const Vec3& p) { return shape.distance.gridGradient(p); });
}

double meanCurvatureOfCells(const Shape& shape, const Vec3& point)
{
    if (const ExactSolid* solid = shape.distance.solid()) return solid->meanCurvature(point);
    return halfDivergence(shape, point,
                          [&](const Vec3& p) { return shape.distance.cellGradient(p); });
}

}  // namespace scree
