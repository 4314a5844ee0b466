// Symbols: h node spacing, phi signed distance.
#include "core/geometry/signed_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "core/base/check.h"
#include "core/base/parallel.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

constexpr double kHalfDiagonal = 0.86602540378443864676;  // of a unit cell

/// Angle-weighted corner normals and summed edge normals give the right sign everywhere off the
/// surface (Bærentzen and Aanæs 2005).
struct PseudoNormals {
    std::vector<Vec3> corner;                  // per point
    std::map<std::pair<int, int>, Vec3> edge;  // per undirected edge
    std::vector<Vec3> face;                    // per triangle
};

PseudoNormals pseudoNormals(const TriMesh& mesh)
{
    PseudoNormals normals;
    normals.corner.assign(mesh.points.cols(), Vec3::Zero());
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const auto point = [&](int k) -> Vec3 { return mesh.points.col(mesh.triangles(k % 3, f)); };
        const Vec3 normal = (point(1) - point(0)).cross(point(2) - point(0)).normalized();
        normals.face.push_back(normal);
        for (int k = 0; k < 3; ++k) {
            const double angle = angleBetween(point(k + 1) - point(k), point(k + 2) - point(k));
            normals.corner[mesh.triangles(k, f)] += angle * normal;
            const auto ends = std::minmax(mesh.triangles(k, f), mesh.triangles((k + 1) % 3, f));
            normals.edge.try_emplace(ends, Vec3::Zero()).first->second += normal;
        }
    }
    return normals;
}

}  // namespace

SignedDistance::SignedDistance(const ExactSolid& solid, double spacing) : solid_(solid)
{
    nodes_.spacing = spacing;
    domain_ = surfaceBox_ = solid.box();
}

SignedDistance::SignedDistance(const TriMesh& mesh, GridNodes nodes, bool refined)
    : nodes_(std::move(nodes))
{
    domain_.min = nodes_.origin;
    domain_.max = nodes_.origin + nodes_.spacing * Vec3(nodes_.count[0] - 1, nodes_.count[1] - 1,
                                                        nodes_.count[2] - 1);
    for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) surfaceBox_.include(mesh.points.col(v));
    // One per cent more than the bound covers single-precision nodes and the contour value tau.
    band_ = 1.01 * kHalfDiagonal * nodes_.spacing;
    buildFaces(mesh);
    buildCandidates();
    // True normals ask for the faces of a cell even where distances are the grid's alone.
    if (!refined) band_ = 0.0;
}

void SignedDistance::buildFaces(const TriMesh& mesh)
{
    const PseudoNormals normals = pseudoNormals(mesh);
    faces_.resize(mesh.triangles.cols());
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        Face& face = faces_[f];
        for (int k = 0; k < 3; ++k) {
            const int from = mesh.triangles(k, f), to = mesh.triangles((k + 1) % 3, f);
            face.corner[k] = mesh.points.col(from);
            face.normal[k] = normals.corner[from];
            face.normal[3 + k] = normals.edge.at(std::minmax(from, to));
        }
        face.normal[6] = normals.face[f];
        for (int k = 0; k < 3; ++k) {
            face.angle[k] = angleBetween(face.corner[(k + 1) % 3] - face.corner[k],
                                         face.corner[(k + 2) % 3] - face.corner[k]);
        }
    }
}

void SignedDistance::buildCandidates()
{
    const double h = nodes_.spacing;
    const int cx = nodes_.count[0] - 1, cy = nodes_.count[1] - 1, cz = nodes_.count[2] - 1;
    const auto node = [&](int i, int j, int k) -> double {
        return nodes_.values[i + static_cast<std::size_t>(nodes_.count[0]) *
                                     (j + static_cast<std::size_t>(nodes_.count[1]) * k)];
    };
    struct Near {
        std::uint32_t face;
        double distance;
    };
    std::vector<std::vector<Near>> near(static_cast<std::size_t>(cx) * cy * cz);

    // A triangle can be closest somewhere in a cell only if, seen from the cell's centre, it is at
    // most a cell diagonal farther than the closest one. Distances from a centre whose cell needs
    // refining are at most band + half a diagonal.
    const double reach = band_ + kHalfDiagonal * h + 2.0 * kHalfDiagonal * h;
    parallelFor(cz, 1, [&](std::size_t begin, std::size_t end) {
        for (std::uint32_t f = 0; f < faces_.size(); ++f) {
            const Face& face = faces_[f];
            Aabb box;
            for (const Vec3& corner : face.corner) box.include(corner);
            const Vec3 low = (box.min - Vec3::Constant(reach) - nodes_.origin) / h;
            const Vec3 high = (box.max + Vec3::Constant(reach) - nodes_.origin) / h;
            const auto first = [&](int axis, int limit) {
                return std::clamp(static_cast<int>(std::floor(low[axis])), 0, limit);
            };
            const auto last = [&](int axis, int limit) {
                return std::clamp(static_cast<int>(std::floor(high[axis])) + 1, 0, limit);
            };
            const int kBegin = std::max(first(2, cz), static_cast<int>(begin));
            const int kEnd = std::min(last(2, cz), static_cast<int>(end));
            for (int k = kBegin; k < kEnd; ++k) {
                for (int j = first(1, cy); j < last(1, cy); ++j) {
                    for (int i = first(0, cx); i < last(0, cx); ++i) {
                        double lowest = 1e300, highest = -1e300, nearest = 1e300;
                        for (int corner = 0; corner < 8; ++corner) {
                            const double phi =
                                node(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2));
                            lowest = std::min(lowest, phi);
                            highest = std::max(highest, phi);
                            nearest = std::min(nearest, std::abs(phi));
                        }
                        if (lowest > band_ || highest < -band_) continue;
                        const Vec3 centre = nodes_.origin + h * Vec3(i + 0.5, j + 0.5, k + 0.5);
                        const double limit = nearest + 3.0 * kHalfDiagonal * h;
                        if (std::abs(face.normal[6].dot(centre - face.corner[0])) > limit) continue;
                        const Vec3 closest = closestOnTriangle(centre, face.corner[0],
                                                               face.corner[1], face.corner[2])
                                                 .point;
                        const double distance = (centre - closest).norm();
                        if (distance > limit) continue;
                        near[i +
                             static_cast<std::size_t>(cx) * (j + static_cast<std::size_t>(cy) * k)]
                            .push_back({f, distance});
                    }
                }
            }
        }
    });

    candidateStart_.assign(near.size() + 1, 0);
    for (std::size_t cell = 0; cell < near.size(); ++cell) {
        double closest = 1e300;
        for (const Near& entry : near[cell]) closest = std::min(closest, entry.distance);
        for (const Near& entry : near[cell]) {
            if (entry.distance <= closest + 2.0 * kHalfDiagonal * h * (1.0 + 1e-9)) {
                candidates_.push_back(entry.face);
            }
        }
        candidateStart_[cell + 1] = static_cast<std::uint32_t>(candidates_.size());
    }
}

std::size_t SignedDistance::cellIndex(const Vec3& pointInDomain) const
{
    const Vec3 grid = (pointInDomain - nodes_.origin) / nodes_.spacing;
    const int i = std::clamp(static_cast<int>(grid.x()), 0, nodes_.count[0] - 2);
    const int j = std::clamp(static_cast<int>(grid.y()), 0, nodes_.count[1] - 2);
    const int k = std::clamp(static_cast<int>(grid.z()), 0, nodes_.count[2] - 2);
    const auto cx = static_cast<std::size_t>(nodes_.count[0] - 1);
    const auto cy = static_cast<std::size_t>(nodes_.count[1] - 1);
    return i + cx * (j + cy * k);
}

double SignedDistance::gridValue(const Vec3& point) const
{
    if (solid_) return solid_->value(point);
    const Vec3 inside = point.cwiseMax(domain_.min).cwiseMin(domain_.max);
    const double inverseSpacing = 1.0 / nodes_.spacing;
    const double x = (inside.x() - nodes_.origin.x()) * inverseSpacing;
    const double y = (inside.y() - nodes_.origin.y()) * inverseSpacing;
    const double z = (inside.z() - nodes_.origin.z()) * inverseSpacing;
    const int i = std::min(static_cast<int>(x), nodes_.count[0] - 2);
    const int j = std::min(static_cast<int>(y), nodes_.count[1] - 2);
    const int k = std::min(static_cast<int>(z), nodes_.count[2] - 2);
    const double fx = x - i, fy = y - j, fz = z - k;
    const std::size_t nx = nodes_.count[0], nxy = nx * nodes_.count[1];
    const float* corner = nodes_.values.data() + i + nx * j + nxy * k;
    const auto alongX = [&](std::size_t offset) {
        const double a = corner[offset], b = corner[offset + 1];
        return a + fx * (b - a);
    };
    const double y0 = alongX(0) + fy * (alongX(nx) - alongX(0));
    const double y1 = alongX(nxy) + fy * (alongX(nxy + nx) - alongX(nxy));
    const double phi = y0 + fz * (y1 - y0);
    if (inside == point) return phi;
    return phi + (point - inside).norm();
}

double SignedDistance::value(const Vec3& point) const
{
    const double phi = gridValue(point);
    if (solid_ || std::abs(phi) >= band_) return phi;
    return exact(point);
}

double SignedDistance::lowerBound(const Vec3& point) const
{
    if (solid_) return solid_->value(point);
    if (domain_.distanceTo(point) > 0.0) return surfaceBox_.distanceTo(point);
    const double phi = gridValue(point);
    return std::abs(phi) < band_ ? exact(point) : phi - kHalfDiagonal * nodes_.spacing;
}

bool SignedDistance::isClearOf(const Vec3& point, double radius) const
{
    if (solid_) return solid_->value(point) > radius;
    return surfaceBox_.distanceTo(point) > radius || lowerBound(point) > radius;
}

SignedDistance::Closest SignedDistance::closestInCell(const Vec3& point) const
{
    const std::size_t cell = cellIndex(point);
    Closest best{nullptr, TriangleFeature::face, Vec3::Zero(), 1e300};
    for (std::uint32_t i = candidateStart_[cell]; i < candidateStart_[cell + 1]; ++i) {
        const Face& face = faces_[candidates_[i]];
        // Nothing of a triangle is closer than its plane.
        const double height = face.normal[6].dot(point - face.corner[0]);
        if (height * height >= best.squaredDistance) continue;
        const ClosestOnTriangle closest =
            closestOnTriangle(point, face.corner[0], face.corner[1], face.corner[2]);
        const double squared = (point - closest.point).squaredNorm();
        if (squared < best.squaredDistance) best = {&face, closest.feature, closest.point, squared};
    }
    SCREE_CHECK(best.face != nullptr, "a cell near the surface has no triangles");
    return best;
}

double SignedDistance::signedValue(const Closest& closest, const Vec3& point)
{
    const Vec3& normal = closest.face->normal[static_cast<int>(closest.feature)];
    // The plane's distance keeps its last bits where the square root of a square would not.
    if (closest.feature == TriangleFeature::face)
        return normal.dot(point - closest.face->corner[0]);
    return std::copysign(std::sqrt(closest.squaredDistance), normal.dot(point - closest.point));
}

double SignedDistance::exact(const Vec3& point) const
{
    return signedValue(closestInCell(point), point);
}

SignedDistance::Nearest SignedDistance::nearest(const Vec3& point) const
{
    const Closest closest = closestInCell(point);
    return {signedValue(closest, point), closest.point, closest.feature == TriangleFeature::face,
            closest.face->normal[6]};
}

SignedDistance::Sloped SignedDistance::sloped(const Vec3& point) const
{
    if (solid_) return {solid_->value(point), solid_->gradient(point)};
    const double grid = gridValue(point);
    if (std::abs(grid) >= band_) return {grid, gridGradient(point)};
    const Closest closest = closestInCell(point);
    const double phi = signedValue(closest, point);
    const Vec3& normal = closest.face->normal[static_cast<int>(closest.feature)];
    const bool onSurface = std::abs(phi) < 1e-9 * nodes_.spacing;
    if (closest.feature == TriangleFeature::face) return {phi, normal};
    if (onSurface) return {phi, normal.normalized()};
    return {phi, (point - closest.point) / phi};
}

void SignedDistance::facesNear(const Vec3& point, double tolerance,
                               std::vector<NearFace>& faces) const
{
    if (solid_) return solid_->facesNear(point, tolerance, faces);
    const std::size_t cell = cellIndex(point);
    for (std::uint32_t i = candidateStart_[cell]; i < candidateStart_[cell + 1]; ++i) {
        const Face& face = faces_[candidates_[i]];
        const double height = face.normal[6].dot(point - face.corner[0]);
        if (std::abs(height) > tolerance) continue;
        const ClosestOnTriangle closest =
            closestOnTriangle(point, face.corner[0], face.corner[1], face.corner[2]);
        if ((point - closest.point).norm() > tolerance) continue;
        double angle = kPi;
        for (int k = 0; k < 3; ++k) {
            if ((point - face.corner[k]).norm() <= tolerance) angle = face.angle[k];
        }
        faces.push_back({face.normal[6], angle, height});
    }
}

Vec3 SignedDistance::gridGradient(const Vec3& point) const
{
    if (solid_) return solid_->gradient(point);
    const Vec3 centre = point.cwiseMax(domain_.min).cwiseMin(domain_.max);
    Vec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = std::max(centre[axis] - nodes_.spacing, domain_.min[axis]);
        const double high = std::min(centre[axis] + nodes_.spacing, domain_.max[axis]);
        Vec3 a = centre, b = centre;
        a[axis] = low;
        b[axis] = high;
        gradient[axis] = (gridValue(b) - gridValue(a)) / (high - low);
    }
    return gradient;
}

}  // namespace scree
