#include "core/geometry/inner_ball.h"

#include <algorithm>

namespace scree {

Points pointsInside(const TriMesh& mesh, double thickness)
{
    Points normals = Points::Zero(3, mesh.points.cols());
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const Vec3 normal = cornersOf(mesh, f).areaVector();
        for (int k = 0; k < 3; ++k) normals.col(mesh.triangles(k, f)) += normal;
    }
    Points inside = mesh.points;
    for (Eigen::Index v = 0; v < inside.cols(); ++v) {
        inside.col(v) -= 0.5 * thickness * normals.col(v).normalized();
    }
    return inside;
}

Ball largestBallInside(const TriMesh& mesh, const SignedDistance& distance, double thickness)
{
    Ball best{Vec3::Zero(), -distance.value(Vec3::Zero())};
    const auto tryAt = [&](const Vec3& centre) {
        const double radius = -distance.value(centre);
        if (radius <= best.radius) return false;
        best = {centre, radius};
        return true;
    };
    const Points inside = pointsInside(mesh, thickness);
    for (Eigen::Index i = 0; i < inside.cols(); ++i) tryAt(inside.col(i));

    constexpr double kFirstStep = 0.25, kLastStep = 0.01;  // as shares of the thickness
    // What is flat to the rounding of its numbers is better by rounding for ever.
    int movesLeft = 20'000;
    for (double step = kFirstStep; step > kLastStep; step *= 0.5) {
        bool isBetter = true;
        while (isBetter && movesLeft-- > 0) {
            isBetter = false;
            const Vec3 from = best.centre;
            for (int axis = 0; axis < 3; ++axis) {
                for (const double way : {-step, step})
                    isBetter |= tryAt(from + way * thickness * Vec3::Unit(axis));
            }
        }
    }
    best.radius = std::max(best.radius, 0.0);
    return best;
}

}  // namespace scree
