// Symbols: phi signed distance of a sample to the other body, tau contour value, h node spacing of
//          the field.
#include "core/collision/interference.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/collision/edge_depth.h"
#include "core/collision/moving_samples.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// Ways and bounds are sums of rounded terms; this share of them covers it.
constexpr double kRounding = 1e-12;

/// The bound of an edge is found anew when the pair has moved by this fraction of h since.
constexpr double kStale = 0.02;

std::array<OneWay, 2> bothWays(const PlacedPair& pair)
{
    return {
        OneWay{pair.shapeA, pair.shapeB, relativePose(pair.worldFromB, pair.worldFromA), true},
        OneWay{pair.shapeB, pair.shapeA, relativePose(pair.worldFromA, pair.worldFromB), false}};
}

std::optional<Touch> touchOfVertex(const OneWay& way, std::int32_t v, double phi, double tau)
{
    if (phi >= tau) return std::nullopt;
    return Touch{phi, v, way.sampleOnA, way.sampled->samples.vertices.col(v)};
}

double distanceOfVertex(const OneWay& way, std::int32_t v, const KnownField& field)
{
    return field.value(way.pose * way.sampled->samples.vertices.col(v));
}

double lowerBoundOfVertex(const OneWay& way, std::int32_t v)
{
    return way.field->distance.lowerBound(way.pose * way.sampled->samples.vertices.col(v));
}

/// An edge of one body placed in the field of the other.
struct PlacedEdge {
    KnownField field;
    EdgeInField line;
    double phiStart;
    double limit;       // below it a point of the edge is a sample
    double lowerBound;  // of the whole edge, from its ends alone
};

PlacedEdge placeEdge(const OneWay& way, std::int32_t e, double tau, const KnownField& field)
{
    const EdgeInField line = placeEdge(way.sampled->samples, e, way.pose, field);
    const double phiStart = field.value(line.start), phiEnd = field.value(line.at(line.steps));
    // Distance is 1-Lipschitz along the edge.
    return {field, line, phiStart, edgeLimit(field, phiStart, phiEnd, tau),
            0.5 * (phiStart + phiEnd - line.length())};
}

/// The samples of an edge that can have some.
template <typename Add>
void touchEdge(const OneWay& way, std::int32_t e, const PlacedEdge& edge, Add&& add)
{
    const SurfaceSamples& samples = way.sampled->samples;
    thread_local std::vector<EdgeDepth> found;
    found.clear();
    sampleEdge(edge.field, edge.line, edge.phiStart, edge.limit, found);
    const auto [a, b] = samples.edges[e];
    const auto firstId = static_cast<std::int32_t>(samples.vertices.cols()) + 3 * e;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double s = found[i].t / edge.line.steps;
        const Vec3 p =
            samples.vertices.col(a) + s * (samples.vertices.col(b) - samples.vertices.col(a));
        add(Touch{found[i].phi, firstId + static_cast<std::int32_t>(i), way.sampleOnA, p});
    }
}

/// Edges against a plane are left to their end points: along an edge the distance is linear.
bool samplesEdges(const OneWay& way)
{
    return !way.field->isPlane;
}

bool boundingSpheresMeet(const PlacedPair& pair, double clearance)
{
    if (pair.shapeA->isPlane || pair.shapeB->isPlane) return true;
    const double reach = pair.shapeA->boundingRadius + pair.shapeB->boundingRadius + clearance;
    return (pair.worldFromA.position - pair.worldFromB.position).squaredNorm() <= reach * reach;
}

/// The touches of samples that move; nothing is remembered of these.
void findMovingOnes(const std::array<OneWay, 2>& ways, double tau, std::vector<Touch>& touches)
{
    for (const OneWay& way : ways) {
        if (!way.sampled->samplesMove) continue;
        findMovingTouches(*way.sampled, *way.field, way.pose, tau, way.sampleOnA, touches);
    }
}

bool isShallower(const Touch& p, const Touch& q)
{
    return isDeeper(q, p);
}

/// The direction in which the samples are those of the smaller body.
std::size_t smallerOf(const PlacedPair& pair)
{
    if (pair.shapeA->isPlane) return 1;
    if (pair.shapeB->isPlane) return 0;
    return pair.shapeA->boundingRadius <= pair.shapeB->boundingRadius ? 0 : 1;
}

/// How far points near the smaller body can have moved in the frame of either: those of its own,
/// and those of the other within `around` of it. Points farther away come nearer by no more than
/// its centre moves.
double travel(const OneWay& smaller, const FieldFromSamples& past, double around)
{
    const FieldFromSamples& now = smaller.pose;
    const double chord = chordOfTurn(past.rotation, now.rotation);
    const double moved = (now.translation - past.translation).norm();
    return moved + chord * (smaller.sampled->boundingRadius + around);
}

}  // namespace

double contourValue(const Shape& a, const Shape& b)
{
    const double diagonalA = a.isPlane ? std::numeric_limits<double>::infinity() : a.box.diagonal();
    const double diagonalB = b.isPlane ? std::numeric_limits<double>::infinity() : b.box.diagonal();
    return 1e-6 * std::min(diagonalA, diagonalB);
}

void Proximity::lookAt(const OneWay& way, double clearance)
{
    const SignedDistance& field = way.field->distance;
    const SurfaceSamples& samples = way.sampled->samples;
    const auto isClear = [&](const Vec3& centre, double radius) {
        return field.isClearOf(way.pose * centre, radius + clearance);
    };
    const auto consider = [&](double atLeast, std::uint32_t index, bool isEdge) {
        if (atLeast >= clearance) return;
        candidates_.push_back(
            {atLeast, -1.0, 0.0, static_cast<std::int32_t>(index), -1, 0, isEdge, way.sampleOnA});
    };
    samples.vertexTree.visit(isClear, [&](std::uint32_t v) {
        consider(lowerBoundOfVertex(way, static_cast<std::int32_t>(v)), v, false);
    });
    if (!samplesEdges(way)) return;
    samples.edgeTree.visit(isClear, [&](std::uint32_t e) {
        const EdgeInField edge = placeEdge(samples, static_cast<std::int32_t>(e), way.pose, field);
        consider(lowerBoundAlong(field, edge, clearance), e, true);
    });
}

void Proximity::place(const PlacedPair& pair, double tau)
{
    const std::size_t smaller = smallerOf(pair);
    const FieldFromSamples before = ways_[smaller].pose;
    ways_ = bothWays(pair);
    tau_ = tau;
    found_.clear();
    findMovingOnes(ways_, tau, found_);
    std::make_heap(found_.begin(), found_.end(), isShallower);

    const double around = 2.0 * (tau + margin_);
    if (isKnown_ && travel(ways_[smaller], lookedAt_, around) <= margin_) {
        way_ += travel(ways_[smaller], before, around) * (1.0 + kRounding) + kRounding * margin_;
        ++placing_;
        return;
    }
    isKnown_ = true;
    margin_ = nextMargin_;
    lookedAt_ = ways_[smaller].pose;
    way_ = 0.0;
    candidates_.clear();
    known_.clear();
    if (boundingSpheresMeet(pair, tau + margin_)) {
        for (const OneWay& way : ways_) lookAt(way, tau + margin_);
    }
    placing_ = 1;
    lowestKey_ = 0.0;
}

void Proximity::add(const Touch& touch)
{
    found_.push_back(touch);
    std::push_heap(found_.begin(), found_.end(), isShallower);
}

KnownField Proximity::fieldAround(const OneWay& way, Candidate& candidate)
{
    if (candidate.known < 0) {
        candidate.known = static_cast<std::int32_t>(known_.size());
        known_.emplace_back();
    }
    return {way.field->distance, &known_[candidate.known]};
}

void Proximity::evaluateEdge(const OneWay& way, Candidate& candidate)
{
    if (way_ <= candidate.silentUntil) return;
    const PlacedEdge edge = placeEdge(way, candidate.index, tau_, fieldAround(way, candidate));
    double atLeast = std::max(candidate.key - way_, edge.lowerBound);
    const SignedDistance& field = way.field->distance;
    if (atLeast < edge.limit && way_ > candidate.boundAt + kStale * field.spacing()) {
        atLeast = lowerBoundAlong(field, edge.line, tau_ + margin_);
        candidate.boundAt = way_;
    }
    candidate.key = atLeast + way_;
    if (atLeast < edge.limit)
        return touchEdge(way, candidate.index, edge, [&](const Touch& touch) { add(touch); });
    // The limit may rise and the bound fall by what the pair moves.
    candidate.silentUntil = way_ + 0.5 * (atLeast - edge.limit);
}

void Proximity::evaluate(Candidate& candidate)
{
    const OneWay& way = ways_[candidate.isOfA ? 0 : 1];
    if (candidate.isEdge) return evaluateEdge(way, candidate);
    const double phi = distanceOfVertex(way, candidate.index, fieldAround(way, candidate));
    const SignedDistance& field = way.field->distance;
    const bool isExact = field.solid() || std::abs(phi) < field.refinementBand();
    candidate.key = way_ + (isExact ? phi : lowerBoundOfVertex(way, candidate.index));
    if (const auto touch = touchOfVertex(way, candidate.index, phi, tau_)) add(*touch);
}

std::optional<Touch> Proximity::next()
{
    if (lowestKey_ - way_ < tau_) {
        lowestKey_ = std::numeric_limits<double>::infinity();
        for (Candidate& candidate : candidates_) {
            const double atLeast = candidate.key - way_;
            const bool matters =
                atLeast < tau_ && (found_.empty() || atLeast <= found_.front().phi);
            if (matters && candidate.seenIn != placing_) {
                candidate.seenIn = placing_;
                evaluate(candidate);
            }
            lowestKey_ = std::min(lowestKey_, candidate.key);
        }
    }
    if (found_.empty()) return std::nullopt;
    const Touch deepest = found_.front();
    std::pop_heap(found_.begin(), found_.end(), isShallower);
    found_.pop_back();
    return deepest;
}

bool Proximity::interferes(const PlacedPair& pair, double tau)
{
    place(pair, tau);
    return next().has_value();
}

void Proximity::findTouches(const PlacedPair& pair, double tau, std::vector<Touch>& touches)
{
    place(pair, tau);
    while (const auto touch = next()) touches.push_back(*touch);
}

std::optional<Touch> deepestTouch(const PlacedPair& pair, double tau)
{
    if (!boundingSpheresMeet(pair, tau)) return std::nullopt;
    const std::array<OneWay, 2> ways = bothWays(pair);
    std::optional<Touch> deepest;
    const auto offer = [&](const Touch& touch) {
        if (!deepest || isDeeper(touch, *deepest)) deepest = touch;
    };
    thread_local std::vector<Touch> moving;
    moving.clear();
    findMovingOnes(ways, tau, moving);
    for (const Touch& touch : moving) offer(touch);
    for (const OneWay& way : ways) {
        const SurfaceSamples& samples = way.sampled->samples;
        const auto isClear = [&](const Vec3& centre, double radius) {
            return way.field->distance.isClearOf(way.pose * centre, radius + tau);
        };
        samples.vertexTree.visit(isClear, [&](std::uint32_t i) {
            const auto v = static_cast<std::int32_t>(i);
            if (const auto touch =
                    touchOfVertex(way, v, distanceOfVertex(way, v, way.field->distance), tau))
                offer(*touch);
        });
        if (!samplesEdges(way)) continue;
        samples.edgeTree.visit(isClear, [&](std::uint32_t i) {
            const auto e = static_cast<std::int32_t>(i);
            const PlacedEdge edge = placeEdge(way, e, tau, way.field->distance);
            if (edge.lowerBound < edge.limit) touchEdge(way, e, edge, offer);
        });
    }
    return deepest;
}

void findTouchesPlainly(const PlacedPair& pair, double tau, std::vector<Touch>& touches)
{
    const std::array<OneWay, 2> ways = bothWays(pair);
    findMovingOnes(ways, tau, touches);
    for (const OneWay& way : ways) {
        const SurfaceSamples& samples = way.sampled->samples;
        for (std::int32_t v = 0; v < samples.vertices.cols(); ++v) {
            const double phi = distanceOfVertex(way, v, way.field->distance);
            if (const auto touch = touchOfVertex(way, v, phi, tau)) touches.push_back(*touch);
        }
        if (!samplesEdges(way)) continue;
        for (std::int32_t e = 0; e < static_cast<std::int32_t>(samples.edges.size()); ++e) {
            const PlacedEdge edge = placeEdge(way, e, tau, way.field->distance);
            if (edge.lowerBound >= edge.limit) continue;
            touchEdge(way, e, edge, [&](const Touch& touch) { touches.push_back(touch); });
        }
    }
}

}  // namespace scree
