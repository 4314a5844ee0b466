// Symbols: a, b, c corners of a triangle from a base point, d = det[a, b, c], the volume of six
//          tetrahedra. The inertia is tr(C) δ − C of the covariance C.
#include "core/geometry/mass_properties.h"

#include <Eigen/Eigenvalues>

#include <array>

#include "core/base/error.h"

namespace scree {
namespace {

/// Points an axis the way its largest component points, so that its sign is not the eigensolver's
/// whim.
Vec3 signFixed(const Vec3& axis)
{
    Eigen::Index largest = 0;
    axis.cwiseAbs().maxCoeff(&largest);
    return axis[largest] < 0.0 ? Vec3(-axis) : axis;
}

/// Two unit vectors across `axis`, the first being the mesh axis that lies flattest in that plane.
std::array<Vec3, 2> planeNearestMeshAxes(const Vec3& axis)
{
    Eigen::Index flattest = 0;
    axis.cwiseAbs().minCoeff(&flattest);
    const Vec3 own = Vec3::Unit(flattest);
    const Vec3 first = (own - own.dot(axis) * axis).normalized();
    return {first, axis.cross(first)};
}

Mat3 principalAxes(const Mat3& eigenvectors, const Vec3& moments)
{
    const double tolerance = 1e-5 * moments.maxCoeff();
    const bool lowEqual = moments[1] - moments[0] < tolerance;
    const bool highEqual = moments[2] - moments[1] < tolerance;
    if (lowEqual && highEqual) return Mat3::Identity();

    Mat3 axes;
    if (lowEqual) {
        const Vec3 single = signFixed(eigenvectors.col(2));
        const auto [u, v] = planeNearestMeshAxes(single);
        axes << u, v, single;
    } else if (highEqual) {
        const Vec3 single = signFixed(eigenvectors.col(0));
        const auto [u, v] = planeNearestMeshAxes(single);
        axes << single, u, v;
    } else {
        const Vec3 first = signFixed(eigenvectors.col(0));
        const Vec3 second = signFixed(eigenvectors.col(1));
        axes << first, second, first.cross(second);
    }
    return axes;
}

}  // namespace

MassProperties massProperties(const TriMesh& mesh)
{
    MassProperties result;
    const Vec3 base = mesh.points.col(mesh.triangles(0, 0));

    // First pass: volume and centre, about a point of the mesh (no cancellation far from the
    // origin).
    Vec3 firstMoment = Vec3::Zero();
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const auto [a, b, c] = cornersOf(mesh, f).seenFrom(base);
        const double d = a.dot(b.cross(c));
        result.volume += d / 6.0;
        result.area += 0.5 * (b - a).cross(c - a).norm();
        firstMoment += d / 24.0 * (a + b + c);
    }
    if (!(result.volume > 0.0)) {
        throw Error(ErrorKind::badInput, "the mesh has no volume (" +
                                             std::to_string(result.volume) +
                                             " m³), so it cannot have a mass");
    }
    const Vec3 centreFromBase = firstMoment / result.volume;
    result.centre = base + centreFromBase;

    // Second pass: covariance about the centre.
    Mat3 covariance = Mat3::Zero();
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        Mat3 corners;
        for (int k = 0; k < 3; ++k) {
            corners.col(k) = mesh.points.col(mesh.triangles(k, f)) - base - centreFromBase;
        }
        const Vec3 sum = corners.rowwise().sum();
        const double d = corners.col(0).dot(corners.col(1).cross(corners.col(2)));
        covariance += d / 120.0 * (corners * corners.transpose() + sum * sum.transpose());
    }
    const Mat3 inertia = covariance.trace() * Mat3::Identity() - covariance;

    const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertia);
    const Mat3 axes = principalAxes(solver.eigenvectors(), solver.eigenvalues());
    for (int k = 0; k < 3; ++k) result.moments[k] = axes.col(k).dot(inertia * axes.col(k));
    result.meshFromPrincipal = Quat(axes).normalized();
    if (!(result.moments.minCoeff() > 0.0)) {
        throw Error(ErrorKind::badInput, "the mesh's inertia is not positive: it is degenerate");
    }
    return result;
}

}  // namespace scree
