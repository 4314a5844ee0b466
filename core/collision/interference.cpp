// Symbols: phi signed distance of a sample to the other body, tau contour value, h node spacing of
//          the field, t position along an edge in lattice steps of at most 2 h.
#include "core/collision/interference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/collision/moving_samples.h"
#include "core/collision/relative_pose.h"

namespace scree {
namespace {

/// Lattice step along an edge in units of h, a sixth of the thinnest wall: a body that an edge can
/// cut between two lattice points is found by the golden section that follows.
constexpr double kStep = 2.0;

/// An edge speaks for itself only where it is deeper than its nearer end by this fraction of h;
/// less than that its vertex says already.
///
/// Departs from A8, which samples an edge whenever both ends are outside and never otherwise. Of
/// the edges of a stack of aligned cubes some always lie outside by micrometres, and sampled they
/// push it about at 1 cm/s; and a ring whose vertex just touches another may cut into it with the
/// edge beside, unsampled, by 17 mm.
constexpr double kDeeperThanEnds = 0.1;

/// Depth that varies less than this fraction of h along an edge is "flat on flat".  [A8]
constexpr double kFlatDepth = 1e-3;

/// An edge seen from the field: fixed lattice points, so that skipping some never changes the rest.
struct EdgeInField {
    Vec3 start, alongStep;  // one lattice step
    int steps;              // lattice points 0 … steps, the ends are vertices
    double stepLength;

    Vec3 at(double t) const { return start + t * alongStep; }
};

EdgeInField placeEdge(const SurfaceSamples& samples, std::int32_t edge,
                      const FieldFromSamples& pose, const SignedDistance& field)
{
    const auto [a, b] = samples.edges[edge];
    const Vec3 start = pose * samples.vertices.col(a);
    const Vec3 end = pose * samples.vertices.col(b);
    const double length = samples.edgeLengths[edge];
    const int steps = std::max(2, static_cast<int>(std::ceil(length / (kStep * field.spacing()))));
    return {start, (end - start) / steps, steps, length / steps};
}

/// How many lattice steps can be skipped when nothing below `wanted` is within reach of phi.
int stepsToSkip(double phi, double wanted, double stepLength)
{
    const double steps = (phi - wanted) / stepLength;
    return steps > 1.0 ? static_cast<int>(std::min(steps, 1e6)) : 1;
}

struct EdgeDepth {
    double t, phi;
};

/// Value and slope per lattice step of the field at a point of the edge.
struct EdgeSlope {
    double t, phi, slope;
};

EdgeSlope slopeAt(const SignedDistance& field, const EdgeInField& edge, double t)
{
    const SignedDistance::Sloped sloped = field.sloped(edge.at(t));
    return {t, sloped.value, sloped.gradient.dot(edge.alongStep)};
}

/// The deepest point near lattice point k, where the field is taken as convex along the edge:
/// tangents from both sides meet below the minimum, and where they meet is the next guess. For a
/// crossing of two edges, whose depth is piecewise linear, two guesses do.
EdgeDepth deepestNear(const SignedDistance& field, const EdgeInField& edge, int k, double tolerance)
{
    EdgeSlope low = slopeAt(field, edge, k);
    EdgeSlope high = low;
    if (low.slope < 0.0) {
        high = slopeAt(field, edge, k + 1.0);
        if (high.slope <= 0.0) return {high.t, high.phi};
    } else {
        low = slopeAt(field, edge, k - 1.0);
        if (low.slope >= 0.0) return {low.t, low.phi};
    }
    EdgeDepth best = low.phi <= high.phi ? EdgeDepth{low.t, low.phi} : EdgeDepth{high.t, high.phi};
    for (int i = 0; i < 10; ++i) {
        const double width = high.t - low.t;
        double t = low.t + (high.phi - low.phi - high.slope * width) / (low.slope - high.slope);
        const double bound = low.phi + low.slope * (t - low.t);
        if (best.phi - bound <= tolerance) break;
        t = std::clamp(t, low.t + 0.01 * width, high.t - 0.01 * width);
        const EdgeSlope middle = slopeAt(field, edge, t);
        if (middle.phi < best.phi) best = {middle.t, middle.phi};
        (middle.slope < 0.0 ? low : high) = middle;
    }
    return best;
}

/// Appends the samples of one edge: its deepest point, or, where the depth is flat, the middle and
/// the ends of the flat part.
/// `atLeast` is what is known of the depth beforehand: nothing along the edge is below it.
void sampleEdge(const SignedDistance& field, const EdgeInField& edge, double tau, double atLeast,
                std::vector<EdgeDepth>& found)
{
    const double phiStart = field.value(edge.start), phiEnd = field.value(edge.at(edge.steps));
    const double limit =
        std::min(tau, std::min(phiStart, phiEnd) - kDeeperThanEnds * field.spacing());
    // Quick reject: distance is 1-Lipschitz along the edge.
    const double length = edge.stepLength * edge.steps;
    if (std::max(atLeast, 0.5 * (phiStart + phiEnd - length)) >= limit) return;

    double bestPhi = limit + edge.stepLength;
    int best = -1;
    for (int k = stepsToSkip(phiStart, bestPhi, edge.stepLength); k < edge.steps;) {
        const double phi = field.value(edge.at(k));
        if (phi < bestPhi) {
            bestPhi = phi;
            best = k;
        }
        k += stepsToSkip(phi, bestPhi, edge.stepLength);
    }
    if (best < 0) return;
    const EdgeDepth deepest = deepestNear(field, edge, best, 1e-4 * field.spacing());
    if (deepest.phi >= limit) return;

    const double flat = kFlatDepth * field.spacing();
    const auto isAsDeep = [&](int k) {
        return k > 0 && k < edge.steps && std::abs(field.value(edge.at(k)) - deepest.phi) < flat;
    };
    int low = best, high = best;
    if (std::abs(bestPhi - deepest.phi) < flat) {
        while (isAsDeep(low - 1)) --low;
        while (isAsDeep(high + 1)) ++high;
    }
    if (high - low < 2) {
        found.push_back(deepest);
        return;
    }
    for (double t : {0.5 * (low + high), static_cast<double>(low), static_cast<double>(high)}) {
        const double phi = field.value(edge.at(t));
        if (phi < limit) found.push_back({t, phi});
    }
}

/// A lower bound of the field along the edge, exact to h/8 or above `enough`: where two points at
/// distance s have values p and q, nothing between them is below (p + q − s)/2.
double lowerBoundAlong(const SignedDistance& field, const EdgeInField& edge, double enough)
{
    const double finest = 0.125 * field.spacing() / edge.stepLength;  // in lattice steps
    double bound = std::numeric_limits<double>::infinity();
    double t = 0.0, phi = field.value(edge.start);
    while (t < edge.steps) {
        const double step = std::max(finest, (phi - enough) / edge.stepLength);
        const double next = std::min(t + step, static_cast<double>(edge.steps));
        const double phiNext = field.value(edge.at(next));
        bound = std::min(bound, 0.5 * (phi + phiNext - (next - t) * edge.stepLength));
        t = next;
        phi = phiNext;
    }
    return bound;
}

struct OneWay {
    const Shape& sampled;
    const Shape& field;
    FieldFromSamples pose;
    bool sampleOnA;
};

std::array<OneWay, 2> bothWays(const PlacedPair& pair)
{
    return {
        OneWay{*pair.shapeA, *pair.shapeB, relativePose(pair.worldFromB, pair.worldFromA), true},
        OneWay{*pair.shapeB, *pair.shapeA, relativePose(pair.worldFromA, pair.worldFromB), false}};
}

void touchVertex(const OneWay& way, std::int32_t v, double tau, std::vector<Touch>& touches)
{
    const Vec3 p = way.sampled.samples.vertices.col(v);
    const double phi = way.field.distance.value(way.pose * p);
    if (phi < tau) touches.push_back({phi, v, way.sampleOnA, p});
}

void touchEdge(const OneWay& way, std::int32_t e, double tau, double atLeast,
               std::vector<Touch>& touches)
{
    const SurfaceSamples& samples = way.sampled.samples;
    const EdgeInField edge = placeEdge(samples, e, way.pose, way.field.distance);
    thread_local std::vector<EdgeDepth> found;
    found.clear();
    sampleEdge(way.field.distance, edge, tau, atLeast, found);
    const auto [a, b] = samples.edges[e];
    const auto firstId = static_cast<std::int32_t>(samples.vertices.cols()) + 3 * e;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double s = found[i].t / edge.steps;
        const Vec3 p =
            samples.vertices.col(a) + s * (samples.vertices.col(b) - samples.vertices.col(a));
        touches.push_back({found[i].phi, firstId + static_cast<std::int32_t>(i), way.sampleOnA, p});
    }
}

/// Edges against a plane are left to their end points: along an edge the distance is linear.
bool samplesEdges(const OneWay& way)
{
    return !way.field.isPlane;
}

bool boundingSpheresMeet(const PlacedPair& pair, double clearance)
{
    if (pair.shapeA->isPlane || pair.shapeB->isPlane) return true;
    const double reach = pair.shapeA->boundingRadius + pair.shapeB->boundingRadius + clearance;
    return (pair.worldFromA.position - pair.worldFromB.position).squaredNorm() <= reach * reach;
}

/// The touches of samples that move; nothing is remembered of these.
void findMovingOnes(const PlacedPair& pair, double tau, std::vector<Touch>& touches)
{
    if (!pair.shapeA->samplesMove && !pair.shapeB->samplesMove) return;
    for (const OneWay& way : bothWays(pair)) {
        if (!way.sampled.samplesMove) continue;
        findMovingTouches(way.sampled, way.field, way.pose, tau, way.sampleOnA, touches);
    }
}

}  // namespace

double contourValue(const Shape& a, const Shape& b)
{
    const double diagonalA = a.isPlane ? std::numeric_limits<double>::infinity() : a.box.diagonal();
    const double diagonalB = b.isPlane ? std::numeric_limits<double>::infinity() : b.box.diagonal();
    return 1e-6 * std::min(diagonalA, diagonalB);
}

void Proximity::reset(double margin)
{
    margin_ = margin;
    isKnown_ = false;
}

bool Proximity::isEmpty() const
{
    return ofA_.vertices.empty() && ofA_.edges.empty() && ofB_.vertices.empty() &&
           ofB_.edges.empty();
}

double Proximity::lookAgainIfMoved(const PlacedPair& pair, double tau)
{
    const std::array<OneWay, 2> ways = bothWays(pair);
    if (isKnown_) {
        // No point of either body has moved farther in the other's frame than this. A plane has no
        // points, and a body's points move in its frame as they do in the world.
        const FieldFromSamples& now = ways[0].pose;
        const auto reach = [](const Shape& shape, double lever) {
            return shape.isPlane ? 0.0 : shape.boundingRadius + lever;
        };
        const double turned = (now.rotation - rotation_).norm();
        const double moved = (now.translation - translation_).norm();
        const double travel =
            moved + turned * std::max(reach(*pair.shapeA, 0.0),
                                      reach(*pair.shapeB, now.translation.norm()));
        if (travel <= margin_) return travel;
    }
    isKnown_ = true;
    rotation_ = ways[0].pose.rotation;
    translation_ = ways[0].pose.translation;
    for (NearSamples* near : {&ofA_, &ofB_}) {
        near->vertices.clear();
        near->edges.clear();
    }

    const double clearance = tau + margin_;
    if (!boundingSpheresMeet(pair, clearance)) return 0.0;
    for (const OneWay& way : ways) {
        NearSamples& near = way.sampleOnA ? ofA_ : ofB_;
        const SignedDistance& field = way.field.distance;
        const auto isClear = [&](const Vec3& centre, double radius) {
            return field.isClearOf(way.pose * centre, radius + clearance);
        };
        way.sampled.samples.vertexTree.visit(isClear, [&](std::uint32_t v) {
            const double atLeast = field.lowerBound(way.pose * way.sampled.samples.vertices.col(v));
            if (atLeast < clearance)
                near.vertices.push_back({atLeast, static_cast<std::int32_t>(v)});
        });
        if (samplesEdges(way)) {
            way.sampled.samples.edgeTree.visit(isClear, [&](std::uint32_t e) {
                const auto id = static_cast<std::int32_t>(e);
                const EdgeInField edge = placeEdge(way.sampled.samples, id, way.pose, field);
                const double atLeast = lowerBoundAlong(field, edge, clearance);
                if (atLeast < clearance) near.edges.push_back({atLeast, id});
            });
        }
        for (std::vector<NearSample>* samples : {&near.vertices, &near.edges}) {
            std::sort(
                samples->begin(), samples->end(), [](const NearSample& p, const NearSample& q) {
                    return p.atLeast < q.atLeast || (p.atLeast == q.atLeast && p.index < q.index);
                });
        }
    }
    return 0.0;
}

void Proximity::findTouches(const PlacedPair& pair, double tau, std::vector<Touch>& touches)
{
    findMovingOnes(pair, tau, touches);
    const double moved = lookAgainIfMoved(pair, tau);
    const double reach = tau + moved;
    if (isEmpty()) return;
    for (const OneWay& way : bothWays(pair)) {
        const NearSamples& near = way.sampleOnA ? ofA_ : ofB_;
        for (const NearSample& v : near.vertices) {
            if (v.atLeast >= reach) break;
            touchVertex(way, v.index, tau, touches);
        }
        for (const NearSample& e : near.edges) {
            if (e.atLeast >= reach) break;
            touchEdge(way, e.index, tau, e.atLeast - moved, touches);
        }
    }
}

bool Proximity::interferes(const PlacedPair& pair, double tau)
{
    thread_local std::vector<Touch> touches;
    touches.clear();
    findMovingOnes(pair, tau, touches);
    if (!touches.empty()) return true;
    const double moved = lookAgainIfMoved(pair, tau);
    const double reach = tau + moved;
    if (isEmpty()) return false;
    for (const OneWay& way : bothWays(pair)) {
        const NearSamples& near = way.sampleOnA ? ofA_ : ofB_;
        for (const NearSample& v : near.vertices) {
            if (v.atLeast >= reach) break;
            touchVertex(way, v.index, tau, touches);
            if (!touches.empty()) return true;
        }
        for (const NearSample& e : near.edges) {
            if (e.atLeast >= reach) break;
            touchEdge(way, e.index, tau, e.atLeast - moved, touches);
            if (!touches.empty()) return true;
        }
    }
    return false;
}

void findTouchesPlainly(const PlacedPair& pair, double tau, std::vector<Touch>& touches)
{
    findMovingOnes(pair, tau, touches);
    for (const OneWay& way : bothWays(pair)) {
        const SurfaceSamples& samples = way.sampled.samples;
        for (std::int32_t v = 0; v < samples.vertices.cols(); ++v)
            touchVertex(way, v, tau, touches);
        if (!samplesEdges(way)) continue;
        for (std::int32_t e = 0; e < static_cast<std::int32_t>(samples.edges.size()); ++e) {
            touchEdge(way, e, tau, -std::numeric_limits<double>::infinity(), touches);
        }
    }
}

}  // namespace scree
