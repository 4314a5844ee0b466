#include "core/geometry/round_facets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/facing_weights.h"

namespace scree {
namespace {

/// Corner normals closer together than kFineTurn make a facet part of a round surface, and those at
/// the ends of its longest edge where they are closer than 20°·√2: half a square that turns by 20°
/// each way is cut along its diagonal. Measured as the others are it made the ends of a capsule of
/// 18° a side coarse, while its side was not, and blows there went 10° off.
constexpr double kFineDiagonal = 0.88052;

constexpr int kMostSteps = 3;  // triangles  [A40]

/// Of the facets around a point those smaller than this share of the largest have no say in its
/// normal: with the mean of all, the face of a box with rounded edges would be a pillow to roll on,
/// and the side of a capsule a barrel.
constexpr double kSmallest = 0.2;
/// Sine of how far an edge may sag inward: files round points, and the squares of a capsule's side
/// of which one bent in by that were the facets of a prism.
constexpr double kHollow = -1e-4;

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
    if (!shares || std::min(shares->ofP, shares->ofQ) < kOutsideFacet) return std::nullopt;
    FacingWeights found{Vec3::Zero(), Mat3::Zero()};
    found.weights[i] = shares->ofP;
    found.weights[j] = shares->ofQ;
    found.change.row(i) = shares->changeOfP;
    found.change.row(j) = shares->changeOfQ;
    return found;
}

}  // namespace

RoundFacets::RoundFacets(const TriMesh& mesh) : mesh_(mesh), fans_(mesh)
{
    findNormals();
    findRoundFacets();
}

/// [Max99]: exact where the points lie on a sphere, however uneven the facets. Of a fillet beside a
/// flat face the face decides.
void RoundFacets::findNormals()
{
    std::vector<double> largest(static_cast<std::size_t>(mesh_.points.cols()), 0.0);  // area [m²]
    for (std::int32_t f = 0; f < fans_.triangleCount(); ++f) {
        const double area = cornersOf(mesh_, f).areaVector().norm();
        for (const int v : mesh_.triangles.col(f)) largest[v] = std::max(largest[v], area);
    }
    normals_.setZero(3, mesh_.points.cols());
    for (std::int32_t f = 0; f < fans_.triangleCount(); ++f) {
        const TriangleCorners corners = cornersOf(mesh_, f);
        const Vec3 own = corners.areaVector();
        for (int k = 0; k < 3; ++k) {
            const int v = mesh_.triangles(k, f);
            if (own.norm() < kSmallest * largest[v]) continue;
            const auto& p = corners[k];
            const Vec3 toNext = corners[(k + 1) % 3] - p, toLast = corners[(k + 2) % 3] - p;
            normals_.col(v) += own / (toNext.squaredNorm() * toLast.squaredNorm());
        }
    }
    for (auto normal : normals_.colwise()) normal.normalize();
}

void RoundFacets::findRoundFacets()
{
    const auto count = static_cast<std::size_t>(fans_.triangleCount());
    isRound_.assign(count, 0);
    std::vector<char> isHollow(count, 0);
    std::vector<double> sags(count, 0.0);  // the most along an edge [m]
    for (std::int32_t f = 0; f < fans_.triangleCount(); ++f) {
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
            isRound = isRound && turns[k] >= (k == longest ? kFineDiagonal : kFineTurn);
        isRound_[f] = isRound;
        sags[f] = most;
    }
    // What is between round and hollow is faced in strips: where a body lies there, the next hair
    // of a tilt finds another place, or none.
    for (std::int32_t f = 0; f < fans_.triangleCount(); ++f) {
        const bool isBesideHollow = std::ranges::any_of(
            fans_.beyond(f), [&](std::int32_t other) { return other >= 0 && isHollow[other]; });
        if (isHollow[f] || isBesideHollow) isRound_[f] = 0;
        // Products of weights add up to a third at most.
        if (isRound_[f]) bulge_ = std::max(bulge_, sags[f] / 3.0);
    }
}

bool RoundFacets::areAll() const
{
    return !isEmpty() && std::ranges::count(isRound_, 0) == 0;
}

RoundFacets::Facet RoundFacets::facetAt(std::int32_t triangle) const
{
    Facet facet;
    for (int k = 0; k < 3; ++k) {
        facet.points.col(k) = mesh_.points.col(mesh_.triangles(k, triangle));
        facet.normals.col(k) = normals_.col(mesh_.triangles(k, triangle));
    }
    return facet;
}

std::int32_t RoundFacets::atVertex(std::int32_t vertex, const Vec3& direction) const
{
    std::int32_t best = -1;
    double least = -std::numeric_limits<double>::infinity();
    for (const std::int32_t triangle : fans_.around(vertex)) {
        if (!isRound_[triangle]) continue;
        const std::optional<FacingWeights> found =
            facingWeights(facetAt(triangle).normals, direction, kBendsBothWays);
        const double here = found ? found->weights.minCoeff() : least;
        if (best >= 0 && here <= least) continue;
        best = triangle;
        least = here;
    }
    return best;
}

bool RoundFacets::areRoundAround(std::int32_t vertex) const
{
    return std::ranges::all_of(fans_.around(vertex),
                               [&](std::int32_t triangle) { return isRound_[triangle] != 0; });
}

RoundPlace RoundFacets::placeAt(const Facet& facet, const Vec3& weights, const Mat3& change) const
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

RoundSearch RoundFacets::findFacing(std::int32_t& triangle, const Vec3& direction,
                                    RoundPlace& place) const
{
    for (int step = 0; step <= kMostSteps; ++step) {
        const Facet facet = facetAt(triangle);
        const std::optional<FacingWeights> found =
            facingWeights(facet.normals, direction, kBendsBothWays);
        if (!found) return RoundSearch::notRound;
        Eigen::Index leaving = 0;
        if (found->weights.minCoeff(&leaving) >= kOutsideFacet) {
            place = placeAt(facet, found->weights, found->change);
            return RoundSearch::found;
        }
        const std::int32_t next = fans_.beyond(triangle)[leaving];
        if (!isRound_[next]) return RoundSearch::notRound;
        if (std::abs(facetAt(next).normals.determinant()) <= kBendsBothWays) {
            // The side of a capsule bends one way only: it is faced where it ends.
            const auto onEdge = facingEdge(facet.normals, leaving, direction);
            if (!onEdge) return RoundSearch::onSide;
            place = placeAt(facet, onEdge->weights, onEdge->change);
            const Vec3 beyond = facet.points.col((leaving + 1) % 3) - facet.points.col(leaving);
            const Vec3 out =
                facet.normals.col((leaving + 1) % 3).cross(facet.normals.col((leaving + 2) % 3));
            place.isPastEnd = out.dot(direction) * out.dot(beyond) >
                              kLeansOver * std::abs(out.dot(beyond)) * out.norm();
            return RoundSearch::found;
        }
        triangle = next;
    }
    return RoundSearch::elsewhere;
}

std::optional<RoundFacets::SideFacet> RoundFacets::sideFacetAt(std::int32_t triangle) const
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

std::optional<Vec3> RoundFacets::axisOf(std::int32_t triangle) const
{
    const std::optional<SideFacet> side = sideFacetAt(triangle);
    if (!side) return {};
    return side->axis;
}

std::int32_t RoundFacets::sideAtEdge(std::int32_t vertex, std::int32_t other) const
{
    std::int32_t found = -1;
    for (const std::int32_t triangle : fans_.around(vertex)) {
        if (!(mesh_.triangles.col(triangle).array() == other).any()) continue;
        if (!sideFacetAt(triangle)) return -1;
        if (found < 0) found = triangle;
    }
    return found;
}

RoundSearch RoundFacets::findAcross(std::int32_t& triangle, const Vec3& direction,
                                    RoundPlace& place) const
{
    for (int step = 0; step <= kMostAcross; ++step) {
        const std::optional<SideFacet> side = sideFacetAt(triangle);
        if (!side) return RoundSearch::elsewhere;
        const int k = side->beside, one = (k + 1) % 3, other = (k + 2) % 3;
        const Vec3 normalBeside = side->facet.normals.col(k);
        const auto shares =
            facingBetween(side->normalOfLine(), normalBeside, side->axis, direction);
        if (!shares) return RoundSearch::elsewhere;
        const double beside = shares->ofQ;
        if (beside >= kOutsideFacet && beside <= 1.0 - kOutsideFacet) {
            Vec3 weights;
            Mat3 change;
            weights[k] = beside;
            weights[one] = weights[other] = 0.5 * (1.0 - beside);
            change.row(k) = shares->changeOfQ;
            change.row(one) = change.row(other) = 0.5 * shares->changeOfP;
            place = placeAt(side->facet, weights, change);
            return RoundSearch::found;
        }
        if (beside < 0.0) {
            triangle = fans_.beyond(triangle)[k];
            continue;
        }
        // Past the corner beside the line: the facet that has its line there.
        std::int32_t next = -1;
        double nearest = -1.0;
        for (const int across : {one, other}) {
            const std::optional<SideFacet> there = sideFacetAt(fans_.beyond(triangle)[across]);
            const double same = there ? there->normalOfLine().dot(normalBeside) : -1.0;
            if (same <= nearest) continue;
            nearest = same;
            next = fans_.beyond(triangle)[across];
        }
        if (next < 0) return RoundSearch::elsewhere;
        triangle = next;
    }
    return RoundSearch::elsewhere;
}

}  // namespace scree
