#include "core/geometry/revolution.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/round_place.h"

namespace scree {

Vec3 turnsThatShow(const TriMesh& mesh)
{
    // A prism of the coarsest facets that are round turns its normals so far from its corners.
    const double most = std::sqrt(0.5 * (1.0 - kFineTurn)) + 1e-6;
    // What stands nearer to an axis than files tell, as the tip of a screw, is on it.
    constexpr double kRounded = 1e-5;
    const double least = kRounded * std::sqrt(mesh.points.colwise().squaredNorm().maxCoeff());
    Vec3 show = Vec3::Zero();
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const TriangleCorners corners = cornersOf(mesh, f);
        const Vec3 normal = corners.normal();
        for (int k = 0; k < 3; ++k) {
            // How fast the place leaves its facet when it turns about an axis, and how fast it
            // moves.
            const Vec3 leaving = corners[k].cross(normal);
            for (int axis = 0; axis < 3; ++axis) {
                const double moving = Vec3::Unit(axis).cross(corners[k]).norm();
                if (std::abs(leaving[axis]) > std::max(most * moving, least)) show[axis] = 1.0;
            }
        }
    }
    return show;
}

Capsule capsuleOf(const TriMesh& mesh, const RoundFacets& facets)
{
    constexpr double kRounded = 1e-4;  // in a file, six digits of a metre of something small
    if (!facets.areAll()) return {};
    for (int axis = -1; axis < 3; ++axis) {  // first of all a ball
        Points across = mesh.points;
        double half = 0.0;
        if (axis >= 0) {
            const double highest = across.row(axis).cwiseAbs().maxCoeff();
            across.row(axis).setZero();
            half = highest - across.colwise().norm().maxCoeff();
            if (half <= 0.0) continue;
            across.row(axis) = (mesh.points.row(axis).array().abs() - half).max(0.0);
        }
        const Eigen::RowVectorXd distances = across.colwise().norm();
        const double radius = distances.maxCoeff();
        if (distances.minCoeff() < (1.0 - kRounded) * radius) continue;
        return {axis < 0 ? Vec3(Vec3::Zero()) : Vec3(half * Vec3::Unit(axis)), radius};
    }
    return {};
}

}  // namespace scree
