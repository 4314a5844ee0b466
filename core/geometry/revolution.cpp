#include "core/geometry/revolution.h"

#include <cmath>

#include "core/geometry/round_place.h"

namespace scree {

Vec3 turnsThatShow(const TriMesh& mesh)
{
    // A prism of the coarsest facets that are round turns its normals so far from its corners.
    const double most = std::sqrt(0.5 * (1.0 - kFineTurn)) + 1e-6;
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
                if (std::abs(leaving[axis]) > most * moving) show[axis] = 1.0;
            }
        }
    }
    return show;
}

double ballRadiusOf(const TriMesh& mesh, const RoundFacets& facets)
{
    constexpr double kSinglePrecision = 1e-5;  // as files have it, and their centre of mass
    if (!facets.areAll()) return 0.0;
    const Eigen::RowVectorXd distances = mesh.points.colwise().norm();
    const double radius = distances.maxCoeff();
    return distances.minCoeff() >= (1.0 - kSinglePrecision) * radius ? radius : 0.0;
}

}  // namespace scree
