// Symbols: h node spacing, phi signed distance.
#include "core/geometry/signed_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/check.h"
#include "core/geometry/mesh_edges.h"
#include "core/math/point_box.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// Gradients shorter than this are near the medial axis and lead nowhere.  [A5]
constexpr double kNoSlope = 0.1;

/// Of squared distances near the surface, in spacings².
constexpr double kSquaredRounding = 1e-12;

/// Of lengths there, in spacings.
constexpr double kLengthRounding = 1e-6;

}  // namespace

SignedDistance::SignedDistance(const ExactSolid& solid, double spacing)
    : solid_(solid), solidSpacing_(spacing)
{
    domain_ = surfaceBox_ = solid.box();
}

SignedDistance::SignedDistance(const TriMesh& mesh, DistanceField field, bool refined)
    : field_(std::move(field))
{
    const NodeLayout& layout = field_.nodes.layout;
    domain_ = {layout.origin, layout.last()};
    surfaceBox_ = boxOf(mesh.points);
    buildFaces(mesh);
    // True normals ask for the faces of a cell even where distances are the grid's alone.
    if (refined) band_ = refinementBandOf(layout.spacing);
}

std::size_t SignedDistance::byteCount() const
{
    return field_.nodes.byteCount() + sizeof(std::uint32_t) * field_.nearest.start.size() +
           sizeof(ListedFace) * field_.nearest.faces.size() +
           (sizeof(Face) + sizeof(Border)) * faces_.size();
}

/// Angle-weighted corner normals and summed edge normals give the right sign everywhere off the
/// surface [BA05].
void SignedDistance::buildFaces(const TriMesh& mesh)
{
    faces_.resize(mesh.triangles.cols());
    borders_.resize(faces_.size());
    std::vector<Vec3> ofCorner(mesh.points.cols(), Vec3::Zero());
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        const TriangleCorners corners = cornersOf(mesh, f);
        faces_[f] = {corners, corners.normal(), edgeProducts(corners)};
        for (int k = 0; k < 3; ++k) {
            borders_[f].angle[k] = corners.angleAt(k);
            ofCorner[mesh.triangles(k, f)] += borders_[f].angle[k] * faces_[f].normal;
        }
    }
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        for (int k = 0; k < 3; ++k) borders_[f].normal[k] = ofCorner[mesh.triangles(k, f)];
    }
    MeshEdges(mesh).forEach([&](std::span<const TriangleSide> sides) {
        Vec3 ofEdge = Vec3::Zero();
        for (const TriangleSide& side : sides) ofEdge += faces_[side.triangle].normal;
        for (const TriangleSide& side : sides)
            borders_[side.triangle].normal[3 + side.corner] = ofEdge;
    });
}

SignedDistance::CellFaces SignedDistance::facesFor(const Vec3& point, const Vec3& placeInCell) const
{
    const std::array<int, 3> cell = field_.nodes.placeOf(placeInCell).cell;
    const double h = spacing();
    const Vec3 centre =
        field_.nodes.layout.node(cell[0], cell[1], cell[2]) + Vec3::Constant(0.5 * h);
    return {field_.nearest.of(field_.nodes, cell), (point - centre).norm() + kLengthRounding * h};
}

double SignedDistance::gridValue(const Vec3& point) const
{
    if (solid_) return solid_->value(point);
    const Vec3 inside = clamped(point);
    const double phi = field_.nodes.interpolate(field_.nodes.placeOf(inside));
    if (inside == point) return phi;
    return phi + (point - inside).norm();
}

double SignedDistance::value(const Vec3& point) const
{
    const double phi = gridValue(point);
    return isRefined(phi) ? exact(point) : phi;
}

double SignedDistance::lowerBound(const Vec3& point, double gridValue) const
{
    if (solid_) return gridValue;
    if (domain_.distanceTo(point) > 0.0) return surfaceBox_.distanceTo(point);
    if (std::abs(gridValue) < band_) return exact(point);
    const DistanceNodes& nodes = field_.nodes;
    return gridValue - nodes.blockOf(nodes.placeOf(point).cell).slack;
}

bool SignedDistance::isClearOf(const Vec3& point, double radius) const
{
    if (solid_) return solid_->value(point) > radius;
    const Vec3 inBox = point.cwiseMax(surfaceBox_.min).cwiseMin(surfaceBox_.max);
    if (radius >= 0.0 && (point - inBox).squaredNorm() > radius * radius) return true;
    // Far from the surface the block knows without being sampled.  [A10, A11]
    const DistanceNodes& nodes = field_.nodes;
    const DistanceNodes::Place place = nodes.placeOf(clamped(point));
    const FieldBlock& block = nodes.blockOf(place.cell);
    if (block.low - block.slack > radius) return true;
    if (block.high + block.slack < radius) return false;
    return nodes.interpolate(place) - block.slack > radius;
}

/// Whether a face is closer than the best so far, which it then is. Of faces that are as close as
/// each other the first of the mesh answers, so that nothing depends on the order in which they are
/// asked: planes are told to be farther only where rounding cannot be why.
bool SignedDistance::isCloser(std::uint32_t face, const Vec3& point, Closest& best) const
{
    const Face& of = faces_[face];
    const double rounding = kSquaredRounding * spacing() * spacing();
    // Nothing of a triangle is closer than its plane.
    const double height = of.normal.dot(point - of.corners.a);
    if (height * height > best.squaredDistance + rounding) return false;
    const ClosestOnTriangle closest = closestOnTriangle(point, of.corners, of.edges);
    const double squared = (point - closest.point).squaredNorm();
    if (squared > best.squaredDistance) return false;
    if (squared == best.squaredDistance && face > best.face) return false;
    best = {face, closest.feature, closest.point, squared};
    return true;
}

SignedDistance::Closest SignedDistance::closestInCell(const Vec3& point,
                                                      const Vec3& placeInCell) const
{
    const CellFaces near = facesFor(point, placeInCell);
    SCREE_CHECK(!near.faces.empty(), "a cell near the surface has no triangles");
    Closest best;
    double farthest = std::numeric_limits<double>::infinity();
    for (const auto [face, fromCentre] : near.faces) {
        if (fromCentre > farthest) break;
        if (isCloser(face, point, best))
            farthest = near.fromCentre + std::sqrt(best.squaredDistance);
    }
    return best;
}

SignedDistance::Closest SignedDistance::closestOf(const FacePlace& place, const Vec3& point) const
{
    Closest best;
    for (std::uint32_t i = 0; i < place.faceCount; ++i) isCloser(place.faces[i], point, best);
    return best;
}

const Vec3& SignedDistance::normalAt(const Closest& closest) const
{
    if (closest.feature == TriangleFeature::face) return faces_[closest.face].normal;
    return borders_[closest.face].normal[static_cast<int>(closest.feature)];
}

double SignedDistance::signedValue(const Closest& closest, const Vec3& point) const
{
    const Vec3& normal = normalAt(closest);
    // The plane's distance keeps its last bits where the square root of a square would not.
    if (closest.feature == TriangleFeature::face)
        return normal.dot(point - faces_[closest.face].corners.a);
    return std::copysign(std::sqrt(closest.squaredDistance), normal.dot(point - closest.point));
}

SignedDistance::Nearest SignedDistance::nearestOf(const Closest& closest, double value) const
{
    return {value, closest.point, closest.feature == TriangleFeature::face,
            faces_[closest.face].normal, closest.face};
}

double SignedDistance::exact(const Vec3& point) const
{
    return signedValue(closestInCell(point, point), point);
}

SignedDistance::Nearest SignedDistance::nearest(const Vec3& point) const
{
    const Closest closest = closestInCell(point, point);
    return nearestOf(closest, signedValue(closest, point));
}

double SignedDistance::distanceToFace(std::uint32_t face, const Vec3& point) const
{
    const Face& of = faces_[face];
    return (point - closestOnTriangle(point, of.corners, of.edges).point).norm();
}

std::optional<SignedDistance::Nearest> SignedDistance::nearestFromAfar(const Vec3& point) const
{
    constexpr int kSteps = 3;  // the second mends what the first misses by a bent slope
    const DistanceNodes& nodes = field_.nodes;
    Vec3 place = clamped(point);
    double phi = nodes.interpolate(nodes.placeOf(place));
    for (int i = 0; i < kSteps; ++i) {
        const Vec3 slope = nodes.slopeInCell(nodes.placeOf(place));
        if (slope.norm() < kNoSlope) return {};
        place = clamped(place - phi * slope.normalized());
        phi = nodes.interpolate(nodes.placeOf(place));
        if (std::abs(phi) >= band_) continue;
        const Closest closest = closestInCell(point, place);
        return nearestOf(closest, std::sqrt(closest.squaredDistance));
    }
    return {};
}

double SignedDistance::upperBound(const Vec3& point) const
{
    const double phi = gridValue(point);
    if (solid_) return phi;
    return phi + field_.nodes.blockOf(field_.nodes.placeOf(clamped(point)).cell).slack;
}

SignedDistance::Sloped SignedDistance::sloped(const Vec3& point) const
{
    if (solid_) return {solid_->value(point), solid_->gradient(point)};
    const double grid = gridValue(point);
    if (!isRefined(grid)) return {grid, gridGradient(point)};
    return slopedAt(closestInCell(point, point), point);
}

SignedDistance::Sloped SignedDistance::slopedAt(const Closest& closest, const Vec3& point) const
{
    const double phi = signedValue(closest, point);
    const Vec3& normal = normalAt(closest);
    const bool onSurface = std::abs(phi) < 1e-9 * spacing();
    if (closest.feature == TriangleFeature::face) return {phi, normal};
    if (onSurface) return {phi, normal.normalized()};
    return {phi, (point - closest.point) / phi};
}

FacePlace SignedDistance::placeAround(const Vec3& point, double gridValue) const
{
    struct Near {
        double distance = 1e150;
        std::uint32_t face = 0;
    };
    std::array<Near, 3> nearest;  // ascending
    const CellFaces near = facesFor(point, point);
    for (const auto [f, fromCentre] : near.faces) {
        if (fromCentre > near.fromCentre + nearest[2].distance) break;
        const Face& face = faces_[f];
        const Vec3 closest = closestOnTriangle(point, face.corners, face.edges).point;
        Near next{(point - closest).norm(), f};
        for (Near& other : nearest) {
            if (next.distance < other.distance) std::swap(next, other);
        }
    }
    // From the centre of the cell a face that it does not list is farther away than the closest by
    // a diagonal. Beyond the band the grid answers: along each axis it rises no faster than the
    // way.
    const double h = spacing(), root3 = 2.0 * kHalfDiagonal;
    const Vec3 fromCentre = field_.nodes.placeOf(point).fraction - Vec3::Constant(0.5);
    const double unlisted = nearest[0].distance + h * (root3 - 2.0 * fromCentre.norm());
    const double inBand = (band_ - std::abs(gridValue)) / root3;
    const auto reachUpTo = [&](double other) {
        // The closest may fall back by the way that the other comes nearer.
        const double way = 0.5 * (std::min(other, unlisted) - nearest[0].distance);
        return std::min(way, inBand) - kLengthRounding * h;
    };
    // Two faces are equally near an edge of theirs: only within a face one is the closest by
    // itself.
    const double ofOne = reachUpTo(nearest[1].distance);
    const double ofTwo = reachUpTo(nearest[2].distance);
    const bool isOne = ofOne > 0.5 * ofTwo;
    const double reach = isOne ? ofOne : ofTwo;
    if (reach <= 0.0) return {};
    std::array<std::uint32_t, 2> faces = {nearest[0].face, nearest[1].face};
    if (!isOne) std::sort(faces.begin(), faces.end());
    return {point, reach * reach, faces, isOne ? 1u : 2u};
}

double SignedDistance::value(const Vec3& point, const FacePlace& place) const
{
    const Face& face = faces_[place.faces[0]];
    if (place.faceCount == 1) return face.normal.dot(point - face.corners.a);
    return signedValue(closestOf(place, point), point);
}

SignedDistance::Sloped SignedDistance::sloped(const Vec3& point, const FacePlace& place) const
{
    const Face& face = faces_[place.faces[0]];
    if (place.faceCount == 1) return {face.normal.dot(point - face.corners.a), face.normal};
    return slopedAt(closestOf(place, point), point);
}

void SignedDistance::facesNear(const Vec3& point, double tolerance,
                               std::vector<NearFace>& faces) const
{
    if (solid_) return solid_->facesNear(point, tolerance, faces);
    const CellFaces near = facesFor(point, point);
    for (const auto [f, fromCentre] : near.faces) {
        if (fromCentre > near.fromCentre + tolerance) break;
        const Face& face = faces_[f];
        const double height = face.normal.dot(point - face.corners.a);
        if (std::abs(height) > tolerance) continue;
        const ClosestOnTriangle closest = closestOnTriangle(point, face.corners, face.edges);
        const double distance = (point - closest.point).norm();
        if (distance > tolerance) continue;
        double angle = kPi;
        for (int k = 0; k < 3; ++k) {
            if ((point - face.corners[k]).norm() <= tolerance) angle = borders_[f].angle[k];
        }
        faces.push_back({face.normal, angle, height, distance});
    }
}

Vec3 SignedDistance::cellGradient(const Vec3& point) const
{
    if (solid_) return solid_->gradient(point);
    return field_.nodes.slopeInCell(field_.nodes.placeOf(clamped(point)));
}

Vec3 SignedDistance::gridGradient(const Vec3& point) const
{
    if (solid_) return solid_->gradient(point);
    const Vec3 centre = clamped(point);
    Vec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = std::max(centre[axis] - spacing(), domain_.min[axis]);
        const double high = std::min(centre[axis] + spacing(), domain_.max[axis]);
        Vec3 a = centre, b = centre;
        a[axis] = low;
        b[axis] = high;
        gradient[axis] = (gridValue(b) - gridValue(a)) / (high - low);
    }
    return gradient;
}

}  // namespace scree
