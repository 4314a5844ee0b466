// Symbols: phi signed distance of a sample to the other body, tau contour value, h node spacing of
//          the field, t position along an edge in lattice steps of at most 2 h.
#include "core/collision/interference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace scree {
namespace {

/// Lattice step along an edge in units of h, a sixth of the thinnest wall: a body that an edge can
/// cut between two lattice points is found by the golden section that follows.
constexpr double kStep = 2.0;

/// Depth that varies less than this fraction of h along an edge is "flat on flat".  [A8]
constexpr double kFlatDepth = 1e-3;

/// Where the samples of one body lie in the frame of the other.
struct FieldFromSamples {
    Mat3 rotation;
    Vec3 translation;
    Vec3 operator*(const Vec3& p) const { return rotation * p + translation; }
};

FieldFromSamples relativePose(const Pose& worldFromField, const Pose& worldFromSamples)
{
    const Mat3 fieldFromWorld = worldFromField.orientation.toRotationMatrix().transpose();
    return {fieldFromWorld * worldFromSamples.orientation.toRotationMatrix(),
            fieldFromWorld * (worldFromSamples.position - worldFromField.position)};
}

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

/// The deepest point between two lattice points, by golden section.
EdgeDepth deepestBetween(const SignedDistance& field, const EdgeInField& edge, double low,
                         double high)
{
    constexpr double kGolden = 0.61803398874989484820;
    double t1 = high - kGolden * (high - low), t2 = low + kGolden * (high - low);
    double phi1 = field.value(edge.at(t1)), phi2 = field.value(edge.at(t2));
    for (int i = 0; i < 12; ++i) {
        if (phi1 <= phi2) {
            high = t2;
            t2 = t1;
            phi2 = phi1;
            t1 = high - kGolden * (high - low);
            phi1 = field.value(edge.at(t1));
        } else {
            low = t1;
            t1 = t2;
            phi1 = phi2;
            t2 = low + kGolden * (high - low);
            phi2 = field.value(edge.at(t2));
        }
    }
    return phi1 <= phi2 ? EdgeDepth{t1, phi1} : EdgeDepth{t2, phi2};
}

/// Appends the samples of one edge: its deepest point, or, where the depth is flat, the middle and
/// the ends of the flat part. Nothing when an end point is inside (the vertex speaks for the edge
/// then).
void sampleEdge(const SignedDistance& field, const EdgeInField& edge, int first, int last,
                double tau, std::vector<EdgeDepth>& found)
{
    // Quick reject: distance is 1-Lipschitz along the edge.
    const double phiStart = field.value(edge.start), phiEnd = field.value(edge.at(edge.steps));
    if (phiStart < tau || phiEnd < tau) return;
    if (phiStart + phiEnd > edge.stepLength * edge.steps + 2.0 * tau) return;

    double bestPhi = tau + edge.stepLength;
    int best = -1;
    for (int k = first; k <= last;) {
        const double phi = field.value(edge.at(k));
        if (phi < bestPhi) {
            bestPhi = phi;
            best = k;
        }
        k += stepsToSkip(phi, bestPhi, edge.stepLength);
    }
    if (best < 0) return;
    const EdgeDepth deepest = deepestBetween(field, edge, best - 1.0, best + 1.0);
    if (deepest.phi >= tau) return;

    const double flat = kFlatDepth * field.spacing();
    const auto isAsDeep = [&](int k) {
        return k > 0 && k < edge.steps && std::abs(field.value(edge.at(k)) - deepest.phi) < flat;
    };
    int low = best, high = best;
    if (isAsDeep(best)) {
        while (isAsDeep(low - 1)) --low;
        while (isAsDeep(high + 1)) ++high;
    }
    if (high - low < 2) {
        found.push_back(deepest);
        return;
    }
    for (double t : {0.5 * (low + high), static_cast<double>(low), static_cast<double>(high)}) {
        const double phi = field.value(edge.at(t));
        if (phi < tau) found.push_back({t, phi});
    }
}

/// The lattice points of an edge that are not provably clear of the field by `clearance`.
std::optional<std::array<int, 2>> nearPart(const SignedDistance& field, const EdgeInField& edge,
                                           double clearance)
{
    int first = -1, last = -1;
    for (int k = 1; k < edge.steps; ++k) {
        // A point stands for the stretch up to its neighbours.
        if (field.isClearOf(edge.at(k), clearance + edge.stepLength)) continue;
        if (first < 0) first = k;
        last = k;
    }
    if (first < 0) return std::nullopt;
    return std::array<int, 2>{first, last};
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

void touchEdge(const OneWay& way, std::int32_t e, int first, int last, double tau,
               std::vector<Touch>& touches)
{
    const SurfaceSamples& samples = way.sampled.samples;
    const EdgeInField edge = placeEdge(samples, e, way.pose, way.field.distance);
    thread_local std::vector<EdgeDepth> found;
    found.clear();
    sampleEdge(way.field.distance, edge, first, last, tau, found);
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

void Proximity::lookAgainIfMoved(const PlacedPair& pair, double tau)
{
    const std::array<OneWay, 2> ways = bothWays(pair);
    if (isKnown_) {
        // No point of either body has moved farther in the other's frame than this.
        const FieldFromSamples& now = ways[0].pose;
        const auto radius = [](const Shape& shape) {
            return shape.isPlane ? 0.0 : shape.boundingRadius;
        };
        const double turned = (now.rotation - rotation_).norm();
        const double moved = (now.translation - translation_).norm();
        const double ofA = moved + turned * radius(*pair.shapeA);
        const double ofB = moved + turned * (radius(*pair.shapeB) + now.translation.norm());
        const bool planeB = pair.shapeB->isPlane;
        if (std::max(ofA, planeB ? 0.0 : ofB) <= margin_) return;
    }
    isKnown_ = true;
    rotation_ = ways[0].pose.rotation;
    translation_ = ways[0].pose.translation;
    for (NearSamples* near : {&ofA_, &ofB_}) {
        near->vertices.clear();
        near->edges.clear();
    }

    const double clearance = tau + margin_;
    if (!boundingSpheresMeet(pair, clearance)) return;
    for (const OneWay& way : ways) {
        NearSamples& near = way.sampleOnA ? ofA_ : ofB_;
        const SignedDistance& field = way.field.distance;
        const auto isClear = [&](const Vec3& centre, double radius) {
            return field.isClearOf(way.pose * centre, radius + clearance);
        };
        way.sampled.samples.vertexTree.visit(isClear, [&](std::uint32_t v) {
            if (!isClear(way.sampled.samples.vertices.col(v), 0.0)) {
                near.vertices.push_back(static_cast<std::int32_t>(v));
            }
        });
        if (!samplesEdges(way)) continue;
        way.sampled.samples.edgeTree.visit(isClear, [&](std::uint32_t e) {
            const auto id = static_cast<std::int32_t>(e);
            const EdgeInField edge = placeEdge(way.sampled.samples, id, way.pose, field);
            if (const auto part = nearPart(field, edge, clearance)) {
                near.edges.push_back({id, (*part)[0], (*part)[1]});
            }
        });
    }
}

void Proximity::findTouches(const PlacedPair& pair, double tau, std::vector<Touch>& touches)
{
    lookAgainIfMoved(pair, tau);
    if (ofA_.vertices.empty() && ofA_.edges.empty() && ofB_.vertices.empty() &&
        ofB_.edges.empty()) {
        return;
    }
    for (const OneWay& way : bothWays(pair)) {
        const NearSamples& near = way.sampleOnA ? ofA_ : ofB_;
        for (std::int32_t v : near.vertices) touchVertex(way, v, tau, touches);
        for (const NearEdge& e : near.edges) touchEdge(way, e.edge, e.first, e.last, tau, touches);
    }
}

bool Proximity::interferes(const PlacedPair& pair, double tau)
{
    lookAgainIfMoved(pair, tau);
    thread_local std::vector<Touch> touches;
    touches.clear();
    for (const OneWay& way : bothWays(pair)) {
        const NearSamples& near = way.sampleOnA ? ofA_ : ofB_;
        for (std::int32_t v : near.vertices) {
            touchVertex(way, v, tau, touches);
            if (!touches.empty()) return true;
        }
        for (const NearEdge& e : near.edges) {
            touchEdge(way, e.edge, e.first, e.last, tau, touches);
            if (!touches.empty()) return true;
        }
    }
    return false;
}

void findTouchesPlainly(const PlacedPair& pair, double tau, std::vector<Touch>& touches)
{
    for (const OneWay& way : bothWays(pair)) {
        const SurfaceSamples& samples = way.sampled.samples;
        for (std::int32_t v = 0; v < samples.vertices.cols(); ++v)
            touchVertex(way, v, tau, touches);
        if (!samplesEdges(way)) continue;
        for (std::int32_t e = 0; e < static_cast<std::int32_t>(samples.edges.size()); ++e) {
            const EdgeInField edge = placeEdge(samples, e, way.pose, way.field.distance);
            touchEdge(way, e, 1, edge.steps - 1, tau, touches);
        }
    }
}

}  // namespace scree
