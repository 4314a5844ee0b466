// Symbols: t tangent, a its slope along the way that is faced at an end, s place along an edge,
// 0…1.
#include "core/geometry/round_rims.h"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

constexpr int kMostSteps = 3;    // edges
constexpr double kAtEnd = 1e-9;  // a slope that is none

/// A curve that bends toward the way that is faced by less than this share of all it bends lies
/// flat: all of it may touch. At a tenth a coin that wobbled at less than 6° was one of corners.
constexpr double kBends = 0.02;

/// Of two edges that follow each other, in the same sense: the way the curve goes where they meet,
/// exact for a circle.
Vec3 tangentBetween(const Vec3& along, const Vec3& next)
{
    return (next.norm() * along.normalized() + along.norm() * next.normalized()).normalized();
}

/// How fast a curve turns where two edges meet, both seen from there [1/m]. Of a circle this is the
/// same wherever they do, however uneven they are.
double curvature(const Vec3& away, const Vec3& back)
{
    return (away.normalized() + back.normalized()).norm() / (away.norm() + back.norm());
}

bool isFine(const Vec3& away, const Vec3& back)
{
    return away.normalized().dot(-back.normalized()) >= kFineTurn;
}

/// An edge as seen from one of its ends.
Vec3 awayFrom(int corner, const ConvexEdge& edge)
{
    return (edge.ends[0] == corner ? edge.length : -edge.length) * edge.direction;
}

/// The sharp edges that meet at each corner; all that matters of more than two is that they do.
struct Meeting {
    std::array<std::int32_t, 2> edges = {-1, -1};
    int count = 0;

    std::int32_t otherThan(std::int32_t edge) const
    {
        return edges[0] == edge ? edges[1] : edges[0];
    }
};

std::vector<Meeting> sharpAtCorners(const ContactFeatures& features,
                                    const std::vector<std::int32_t>& sharp)
{
    std::vector<Meeting> at(static_cast<std::size_t>(features.points().cols()));
    for (const std::int32_t e : sharp) {
        for (const int corner : features.edges()[e].ends) {
            Meeting& here = at[static_cast<std::size_t>(corner)];
            if (here.count < 2) here.edges[here.count] = e;
            ++here.count;
        }
    }
    return at;
}

/// How far an edge may lean towards an axis that it lies around, as a share of its length: for
/// rounding in files.
constexpr double kLeans = 1e-3;

/// Whether an edge lies around one of the axes about which turns do not show.
bool liesAround(const Vec3& turnsThatShow, const ConvexEdge& edge)
{
    const Vec3 middle = edge.start + 0.5 * edge.length * edge.direction;
    for (int axis = 0; axis < 3; ++axis) {
        if (turnsThatShow[axis] > 0.0 || std::abs(edge.direction[axis]) > kLeans) continue;
        const Vec3 out = middle - middle[axis] * Vec3::Unit(axis);
        if (std::abs(out.dot(edge.direction)) <= kLeans * edge.length) return true;
    }
    return false;
}

/// Where a straight edge goes on into a fillet the curve turns half as fast as within that, or
/// less: half because the first edge of the fillet turns to one side only. Where the next edge is
/// the last one of the curve, its length tells.
constexpr double kStraight = 0.5, kLonger = 2.0;

/// Whether a straight edge goes on into a round one, both seen from where they meet. With such
/// taken for round a capsule of sixteen sides lay on barrels: it hovered by a hundredth of its
/// length and rocked for ever.
bool isStraightBefore(const std::vector<ConvexEdge>& edges, const std::vector<Meeting>& at,
                      std::int32_t edge, std::int32_t next, const Vec3& away, const Vec3& back)
{
    const ConvexEdge& round = edges[next];
    const auto& ends = edges[edge].ends;
    const bool sharesFirst = round.ends[0] == ends[0] || round.ends[0] == ends[1];
    const int far = round.ends[sharesFirst ? 1 : 0];
    const Meeting& there = at[static_cast<std::size_t>(far)];
    if (there.count == 2) {
        const Vec3 beyond = awayFrom(far, edges[there.otherThan(next)]);
        if (isFine(beyond, -away))
            return curvature(away, back) <= kStraight * curvature(beyond, -away);
    }
    return back.norm() > kLonger * away.norm();
}

}  // namespace

RoundRims::RoundRims(const ContactFeatures& features, const Vec3& turnsThatShow)
{
    const std::vector<ConvexEdge>& edges = features.edges();
    std::vector<std::int32_t> sharp;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        // What is less sharp is left to the facets. Those beside something sharp are none.
        const bool isSharp = edges[e].faceNormal[0].dot(edges[e].faceNormal[1]) < kFineTurn;
        if (isSharp || liesAround(turnsThatShow, edges[e]))
            sharp.push_back(static_cast<std::int32_t>(e));
    }
    const std::vector<Meeting> at = sharpAtCorners(features, sharp);
    rimOfCorner_.assign(at.size(), -1);

    // An edge that goes on at both ends, by a little, and curves away from what is outside.
    rimOfEdge_.assign(edges.size(), -1);
    for (const std::int32_t e : sharp) {
        const ConvexEdge& edge = edges[e];
        Rim rim{{edge.start, edge.start + edge.length * edge.direction},
                {edge.direction, edge.direction},
                {-1, -1},
                edge.intoFace};
        bool isRound = true;
        for (int end = 0; end < 2 && isRound; ++end) {
            const Meeting& here = at[static_cast<std::size_t>(edge.ends[end])];
            isRound = here.count == 2;
            if (!isRound) break;
            const std::int32_t other = here.otherThan(e);
            const ConvexEdge& next = edges[other];
            // Both from the corner that they share.
            const Vec3 away = awayFrom(edge.ends[end], next), back = awayFrom(edge.ends[end], edge);
            isRound = isFine(away, back) &&
                      (away.normalized() + back.normalized()).dot(edge.outward) < 0.0 &&
                      !isStraightBefore(edges, at, e, other, away, back);
            rim.next[end] = other;
            rim.tangents[end] =
                end == 0 ? tangentBetween(-away, back) : tangentBetween(-back, away);
        }
        if (!isRound) continue;
        rimOfEdge_[e] = static_cast<std::int32_t>(rims_.size());
        rims_.push_back(rim);
        for (const int corner : edge.ends) rimOfCorner_[corner] = rimOfEdge_[e];
        bulge_ = std::max(bulge_, edge.length * (rim.tangents[0] - rim.tangents[1]).norm() / 8.0);
    }
    for (Rim& rim : rims_) {
        for (std::int32_t& next : rim.next) next = rimOfEdge_[next];
    }
}

RoundSearch RoundRims::findFacing(std::int32_t& rim, const Vec3& direction, RoundPlace& place) const
{
    for (int step = 0; step <= kMostSteps; ++step) {
        const Rim& here = rims_[rim];
        const double a = here.tangents[0].dot(direction), b = here.tangents[1].dot(direction);
        const Vec3 turn = here.tangents[1] - here.tangents[0];
        if (a - b <= std::max(kBends * turn.norm(), kAtEnd)) return RoundSearch::notRound;
        if (a >= -kAtEnd && b <= kAtEnd) {
            for (const Vec3& into : here.intoFace) {
                if (into.dot(direction) > kSupportSlack) return RoundSearch::elsewhere;
            }
            const double s = std::clamp(a / (a - b), 0.0, 1.0);
            const Vec3 chord = here.ends[1] - here.ends[0];
            // The place moves along the chord; by how much, the tangent tells as it is between both
            // ends. Along the tangent, two rims that cross at a flat angle crept up on each other.
            const Vec3 tangent = here.tangents[0] + s * turn;
            place = {here.ends[0] + s * chord, 0.5 * s * (1.0 - s) * chord.norm() * (a - b),
                     chord / (a - b) * tangent.transpose()};
            return RoundSearch::found;
        }
        const std::int32_t next = here.next[a < 0.0 ? 0 : 1];
        if (next < 0) return RoundSearch::notRound;
        rim = next;
    }
    return RoundSearch::elsewhere;
}

}  // namespace scree
