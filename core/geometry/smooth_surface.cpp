#include "core/geometry/smooth_surface.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace scree {
namespace {

/// Corner normals of a facet closer together than 20° (this is the cosine) make it part of a round
/// surface. Beyond, as on a ring of ten points around its tube (36°), a facet lies flat on the
/// ground and holds the body: taken for round it would roll off.
constexpr double kFineFacet = 0.93969262078590838;
/// The same across the longest edge of a facet, 20°·√2: half a square that turns by 20° each way is
/// cut along its diagonal. Measured as the others are it made the ends of a capsule of 18° a side
/// coarse, while its side was not, and blows there went 10° off.
constexpr double kFineDiagonal = 0.88052;

constexpr int kMostSteps = 3;  // triangles  [A40]

/// Volume that three normals span below which they lie in one plane.
constexpr double kSameNormals = 1e-12;

constexpr double kOnEdge = -1e-9;  // a corner weight above this is not outside

/// Of the facets around a point those smaller than this share of the largest have no say in its
/// normal: with the mean of all, the face of a box with rounded edges would be a pillow to roll on,
/// and the side of a capsule a barrel.
constexpr double kSmallest = 0.2;
constexpr double kHollow = -1e-6;  // sine of how far an edge may sag inward; for rounding

/// Volume of the normals of a facet, or area of those of an edge, below which it does not bend both
/// ways, or not at all. Points may be of single precision.
constexpr double kBendsBothWays = 1e-6, kBends = 1e-3;
/// Sine of how far the way that is faced may lie off the normals of a surface that bends one way.
constexpr double kTilt = 0.3;
/// The same of one that faces the end of such a surface itself: for rounding.
constexpr double kLeansOver = 1e-6;
/// Sine of how far a line along the axis of a side may lie off that.
constexpr double kAlong = 1e-2;
/// Facets that a search across a side passes, two for each strip of it.
constexpr int kMostAcross = 8;

/// How the surface curves away along an edge: over places of the edge with weights p and q of its
/// ends, the smooth surface lies this times p q above it [m].
double sag(const Vec3& alongEdge, const Vec3& changeOfNormal)
{
    return 0.5 * alongEdge.dot(changeOfNormal);
}

/// Corner weights of the place of a facet that faces a direction, and how they change with it.
struct FacingWeights {
    Vec3 weights;  // they add up to 1; one is negative when the place lies outside
    Mat3 change;   // less what keeps their sum
};

/// Nothing when the normals lie in one plane, or look the other way.
std::optional<FacingWeights> facingWeights(const Mat3& normals, const Vec3& direction,
                                           double leastVolume)
{
    Mat3 inverse;
    bool isInvertible = false;
    normals.computeInverseWithCheck(inverse, isInvertible, leastVolume);
    if (!isInvertible) return std::nullopt;
    const Vec3 weights = inverse * direction;
    const double sum = weights.sum();
    if (!(sum > 0.0)) return std::nullopt;
    return FacingWeights{weights / sum, inverse / sum};
}

/// Shares of two normals in a direction, give or take a tilt along the axis across both, and how
/// they change with it.
struct FacingShares {
    double ofP, ofQ;  // they add up to 1; one is negative when the direction lies outside
    Eigen::RowVector3d changeOfP, changeOfQ;
};

/// Nothing when the normals look the other way.
std::optional<FacingShares> facingBetween(const Vec3& p, const Vec3& q, const Vec3& axis,
                                          const Vec3& direction)
{
    Mat3 frame;
    frame << p, q, axis;
    const Mat3 inverse = frame.inverse();
    const double sum = (inverse.row(0) + inverse.row(1)).dot(direction);
    if (!(sum > 0.0)) return std::nullopt;
    return FacingShares{inverse.row(0).dot(direction) / sum, inverse.row(1).dot(direction) / sum,
                        inverse.row(0) / sum, inverse.row(1) / sum};
}

/// facingWeights of the edge opposite a corner.
std::optional<FacingWeights> facingEdge(const Mat3& normals, Eigen::Index opposite,
                                        const Vec3& direction)
{
    const Eigen::Index i = (opposite + 1) % 3, j = (opposite + 2) % 3;
    const Vec3 p = normals.col(i), q = normals.col(j), out = p.cross(q);
    if (out.norm() < kBends) return std::nullopt;
    if (std::abs(out.dot(direction)) > kTilt * out.norm()) return std::nullopt;
    const auto shares = facingBetween(p, q, out.normalized(), direction);
    if (!shares || std::min(shares->ofP, shares->ofQ) < kOnEdge) return std::nullopt;
    FacingWeights found{Vec3::Zero(), Mat3::Zero()};
    found.weights[i] = shares->ofP;
    found.weights[j] = shares->ofQ;
    found.change.row(i) = shares->changeOfP;
    found.change.row(j) = shares->changeOfQ;
    return found;
}

/// What is zero stays so.
void normalizeAll(Points& vectors)
{
    for (Eigen::Index v = 0; v < vectors.cols(); ++v) {
        const Vec3 vector = vectors.col(v);
        vectors.col(v) = vector.normalized();
    }
}

}  // namespace

SmoothSurface::SmoothSurface(const TriMesh& mesh) : mesh_(mesh)
{
    const Eigen::Index vertexCount = mesh.points.cols(), triangleCount = mesh.triangles.cols();

    // Weigh the normals around every vertex by the angles there, count the triangles that have it,
    // and pair those that share an edge.
    normals_.setZero(3, vertexCount);
    fanStart_.assign(static_cast<std::size_t>(vertexCount) + 1, 0);
    std::map<std::pair<int, int>, std::pair<std::int32_t, int>> cornerOfEdge;
    beyond_.assign(static_cast<std::size_t>(triangleCount), {-1, -1, -1});
    for (Eigen::Index f = 0; f < triangleCount; ++f) {
        const TriangleCorners corners = cornersOf(mesh, f);
        const Vec3 normal = corners.normal();
        const auto triangle = static_cast<std::int32_t>(f);
        for (int k = 0; k < 3; ++k) {
            const int v = mesh.triangles(k, f);
            normals_.col(v) += corners.angleAt(k) * normal;
            ++fanStart_[static_cast<std::size_t>(v) + 1];

            const auto edge =
                std::minmax(mesh.triangles((k + 1) % 3, f), mesh.triangles((k + 2) % 3, f));
            const auto [other, isNew] = cornerOfEdge.try_emplace(edge, triangle, k);
            if (isNew) continue;
            beyond_[f][k] = other->second.first;
            beyond_[other->second.first][other->second.second] = triangle;
        }
    }
    normalizeAll(normals_);

    // List the triangles around every vertex.
    for (std::size_t v = 0; v + 1 < fanStart_.size(); ++v) fanStart_[v + 1] += fanStart_[v];
    fan_.resize(static_cast<std::size_t>(3 * triangleCount));
    std::vector<std::int32_t> next(fanStart_.begin(), fanStart_.end() - 1);
    for (Eigen::Index f = 0; f < triangleCount; ++f) {
        for (int k = 0; k < 3; ++k) {
            fan_[next[mesh.triangles(k, f)]++] = static_cast<std::int32_t>(f);
        }
    }
    findRoundFacets();
}

/// [Max99]: exact where the points lie on a sphere, however uneven the facets. Of a fillet beside a
/// flat face the face decides.
void SmoothSurface::findRoundNormals()
{
    const auto scaledNormal = [&](std::int32_t f) -> Vec3 {
        const Vec3 a = mesh_.points.col(mesh_.triangles(0, f));
        const Vec3 b = mesh_.points.col(mesh_.triangles(1, f));
        const Vec3 c = mesh_.points.col(mesh_.triangles(2, f));
        return (b - a).cross(c - a);
    };
    const auto facetCount = static_cast<std::int32_t>(beyond_.size());
    std::vector<double> largest(fanStart_.size(), 0.0);  // around a vertex, twice the area
    for (std::int32_t f = 0; f < facetCount; ++f) {
        for (int k = 0; k < 3; ++k) {
            double& here = largest[static_cast<std::size_t>(mesh_.triangles(k, f))];
            here = std::max(here, scaledNormal(f).norm());
        }
    }
    roundNormals_.setZero(3, mesh_.points.cols());
    for (std::int32_t f = 0; f < facetCount; ++f) {
        const Vec3 own = scaledNormal(f);
        for (int k = 0; k < 3; ++k) {
            const int v = mesh_.triangles(k, f);
            if (own.norm() < kSmallest * largest[static_cast<std::size_t>(v)]) continue;
            const Vec3 p = mesh_.points.col(v);
            const Vec3 next = mesh_.points.col(mesh_.triangles((k + 1) % 3, f));
            const Vec3 last = mesh_.points.col(mesh_.triangles((k + 2) % 3, f));
            roundNormals_.col(v) += own / ((next - p).squaredNorm() * (last - p).squaredNorm());
        }
    }
    normalizeAll(roundNormals_);
}

void SmoothSurface::findRoundFacets()
{
    findRoundNormals();
    isRound_.assign(beyond_.size(), 0);
    std::vector<char> isHollow(beyond_.size(), 0);
    std::vector<double> sags(beyond_.size(), 0.0);  // the most along an edge [m]
    for (std::int32_t f = 0; f < static_cast<std::int32_t>(beyond_.size()); ++f) {
        const Facet facet = facetAt(f);
        bool isRound = true;
        double most = 0.0;
        Vec3 lengths, turns;  // cosines of these
        for (int k = 0; k < 3; ++k) {
            const int next = (k + 1) % 3;
            const Vec3 along = facet.points.col(next) - facet.points.col(k);
            const double sagging = sag(along, facet.normals.col(next) - facet.normals.col(k));
            isHollow[f] = isHollow[f] || sagging < kHollow * along.norm();
            most = std::max(most, sagging);
            lengths[k] = along.norm();
            turns[k] = facet.normals.col(k).dot(facet.normals.col(next));
        }
        int longest = 0;
        lengths.maxCoeff(&longest);
        for (int k = 0; k < 3; ++k)
            isRound = isRound && turns[k] >= (k == longest ? kFineDiagonal : kFineFacet);
        isRound_[f] = isRound;
        sags[f] = most;
    }
    // What is between round and hollow is faced in strips: where a body lies there, the next hair
    // of a tilt finds another place, or none.
    for (std::size_t f = 0; f < beyond_.size(); ++f) {
        const bool isBesideHollow = std::ranges::any_of(
            beyond_[f], [&](std::int32_t other) { return other >= 0 && isHollow[other]; });
        if (isHollow[f] || isBesideHollow) isRound_[f] = 0;
        // Products of weights add up to a third at most.
        if (isRound_[f]) bulge_ = std::max(bulge_, sags[f] / 3.0);
    }
}

SmoothSurface::Facet SmoothSurface::facetAt(std::int32_t triangle) const
{
    Facet facet;
    for (int k = 0; k < 3; ++k) {
        facet.points.col(k) = mesh_.points.col(mesh_.triangles(k, triangle));
        facet.normals.col(k) = roundNormals_.col(mesh_.triangles(k, triangle));
    }
    return facet;
}

std::int32_t SmoothSurface::roundFacetAt(std::int32_t vertex, const Vec3& direction) const
{
    std::int32_t best = -1;
    double least = -std::numeric_limits<double>::infinity();
    for (std::int32_t i = fanStart_[vertex]; i < fanStart_[vertex + 1]; ++i) {
        if (!isRound_[fan_[i]]) continue;
        const std::optional<FacingWeights> found =
            facingWeights(facetAt(fan_[i]).normals, direction, kBendsBothWays);
        const double here = found ? found->weights.minCoeff() : least;
        if (best >= 0 && here <= least) continue;
        best = fan_[i];
        least = here;
    }
    return best;
}

RoundPlace SmoothSurface::placeAt(const Facet& facet, const Vec3& weights, const Mat3& change) const
{
    RoundPlace place{facet.points * weights, 0.0, Mat3::Zero()};
    for (int k = 0; k < 3; ++k) {
        const int next = (k + 1) % 3;
        place.bulge += weights[k] * weights[next] *
                       sag(facet.points.col(next) - facet.points.col(k),
                           facet.normals.col(next) - facet.normals.col(k));
    }
    const Mat3 fromPlace = facet.points.colwise() - place.point;
    place.advance = fromPlace * change;
    return place;
}

SmoothSurface::Search SmoothSurface::findFacing(std::int32_t& triangle, const Vec3& direction,
                                                RoundPlace& place) const
{
    for (int step = 0; step <= kMostSteps; ++step) {
        const Facet facet = facetAt(triangle);
        const std::optional<FacingWeights> found =
            facingWeights(facet.normals, direction, kBendsBothWays);
        if (!found) return Search::notRound;
        Eigen::Index leaving = 0;
        if (found->weights.minCoeff(&leaving) >= kOnEdge) {
            place = placeAt(facet, found->weights, found->change);
            return Search::found;
        }
        const std::int32_t next = beyond_[triangle][leaving];
        if (!isRound_[next]) return Search::notRound;
        if (std::abs(facetAt(next).normals.determinant()) <= kBendsBothWays) {
            // The side of a capsule bends one way only: it is faced where it ends.
            const auto onEdge = facingEdge(facet.normals, leaving, direction);
            if (!onEdge) return Search::onSide;
            place = placeAt(facet, onEdge->weights, onEdge->change);
            const Vec3 beyond = facet.points.col((leaving + 1) % 3) - facet.points.col(leaving);
            const Vec3 out =
                facet.normals.col((leaving + 1) % 3).cross(facet.normals.col((leaving + 2) % 3));
            place.isPastEnd = out.dot(direction) * out.dot(beyond) >
                              kLeansOver * std::abs(out.dot(beyond)) * out.norm();
            return Search::found;
        }
        triangle = next;
    }
    return Search::elsewhere;
}

std::optional<SmoothSurface::SideFacet> SmoothSurface::sideFacetAt(std::int32_t triangle) const
{
    if (!isRound_[triangle]) return {};
    const Facet facet = facetAt(triangle);
    if (std::abs(facet.normals.determinant()) > kBendsBothWays) return {};
    int beside = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const Vec3 change = facet.normals.col((k + 1) % 3) - facet.normals.col((k + 2) % 3);
        if (change.norm() >= least) continue;
        least = change.norm();
        beside = k;
    }
    const Vec3 out = facet.normals.col((beside + 1) % 3).cross(facet.normals.col(beside));
    const Vec3 line = facet.points.col((beside + 2) % 3) - facet.points.col((beside + 1) % 3);
    if (out.norm() < kBends || out.cross(line).norm() > kAlong * out.norm() * line.norm())
        return {};
    return SideFacet{facet, out.normalized(), beside};
}

std::optional<Vec3> SmoothSurface::axisOf(std::int32_t triangle) const
{
    const std::optional<SideFacet> side = sideFacetAt(triangle);
    if (!side) return {};
    return side->axis;
}

std::int32_t SmoothSurface::sideAtEdge(std::int32_t vertex, std::int32_t other) const
{
    std::int32_t found = -1;
    for (std::int32_t i = fanStart_[vertex]; i < fanStart_[vertex + 1]; ++i) {
        if (!(mesh_.triangles.col(fan_[i]).array() == other).any()) continue;
        if (!sideFacetAt(fan_[i])) return -1;
        if (found < 0) found = fan_[i];
    }
    return found;
}

SmoothSurface::Search SmoothSurface::findAcross(std::int32_t& triangle, const Vec3& direction,
                                                RoundPlace& place) const
{
    for (int step = 0; step <= kMostAcross; ++step) {
        const std::optional<SideFacet> side = sideFacetAt(triangle);
        if (!side) return Search::elsewhere;
        const int k = side->beside, one = (k + 1) % 3, other = (k + 2) % 3;
        const Vec3 normalBeside = side->facet.normals.col(k);
        const auto shares =
            facingBetween(side->normalOfLine(), normalBeside, side->axis, direction);
        if (!shares) return Search::elsewhere;
        const double beside = shares->ofQ;
        if (beside >= kOnEdge && beside <= 1.0 - kOnEdge) {
            Vec3 weights;
            Mat3 change;
            weights[k] = beside;
            weights[one] = weights[other] = 0.5 * (1.0 - beside);
            change.row(k) = shares->changeOfQ;
            change.row(one) = change.row(other) = 0.5 * shares->changeOfP;
            place = placeAt(side->facet, weights, change);
            return Search::found;
        }
        if (beside < 0.0) {
            triangle = beyond_[triangle][k];
            continue;
        }
        // Past the corner beside the line: the facet that has its line there.
        std::int32_t next = -1;
        double nearest = -1.0;
        for (const int across : {one, other}) {
            const std::optional<SideFacet> there = sideFacetAt(beyond_[triangle][across]);
            const double same = there ? there->normalOfLine().dot(normalBeside) : -1.0;
            if (same <= nearest) continue;
            nearest = same;
            next = beyond_[triangle][across];
        }
        if (next < 0) return Search::elsewhere;
        triangle = next;
    }
    return Search::elsewhere;
}

std::optional<Vec3> SmoothSurface::weightsFacing(std::int32_t triangle, const Vec3& direction) const
{
    Mat3 normals;
    for (int k = 0; k < 3; ++k) normals.col(k) = normals_.col(mesh_.triangles(k, triangle));
    for (int k = 0; k < 3; ++k) {
        if (normals.col(k).dot(normals.col((k + 1) % 3)) < kFineFacet) return std::nullopt;
    }
    const std::optional<FacingWeights> found = facingWeights(normals, direction, kSameNormals);
    if (!found) return std::nullopt;
    return found->weights;
}

std::optional<Vec3> SmoothSurface::placeFacing(std::int32_t vertex, const Vec3& direction) const
{
    if (isEmpty()) return std::nullopt;
    // Begin with the triangle around the vertex that is left least.
    std::int32_t triangle = -1;
    std::optional<Vec3> weights;
    for (std::int32_t i = fanStart_[vertex]; i < fanStart_[vertex + 1]; ++i) {
        const std::optional<Vec3> here = weightsFacing(fan_[i], direction);
        if (!here || (weights && here->minCoeff() <= weights->minCoeff())) continue;
        weights = here;
        triangle = fan_[i];
    }
    for (int step = 0; weights; ++step) {
        Eigen::Index leaving = 0;
        if (weights->minCoeff(&leaving) >= kOnEdge) {
            Vec3 place = Vec3::Zero();
            for (int k = 0; k < 3; ++k) {
                place += (*weights)[k] * mesh_.points.col(mesh_.triangles(k, triangle));
            }
            return place;
        }
        if (step == kMostSteps) break;
        triangle = beyond_[triangle][leaving];
        weights = weightsFacing(triangle, direction);
    }
    return std::nullopt;
}

}  // namespace scree
