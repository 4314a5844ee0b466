// Symbols: phi signed distance of a point of the edge, tau contour value, h node spacing of the
//          field, t position along an edge in lattice steps of at most 2 h.
#include "core/collision/edge_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace scree {
namespace {

/// Lattice step along an edge in units of h, a sixth of the thinnest wall: a body that an edge can
/// cut between two lattice points is found by the tangents that follow.
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

/// How many lattice steps can be skipped when nothing below `wanted` is within reach of phi.
int stepsToSkip(double phi, double wanted, double stepLength)
{
    const double steps = (phi - wanted) / stepLength;
    return steps > 1.0 ? static_cast<int>(std::min(steps, 1e6)) : 1;
}

/// Value and slope per lattice step of the field at a point of the edge.
struct EdgeSlope {
    double t, phi, slope;
};

EdgeSlope slopeAt(const KnownField& field, const EdgeInField& edge, double t)
{
    const SignedDistance::Sloped sloped = field.sloped(edge.at(t));
    return {t, sloped.value, sloped.gradient.dot(edge.alongStep)};
}

/// The deepest point near lattice point k, where the field is taken as convex along the edge:
/// tangents from both sides meet below the minimum, and where they meet is the next guess. For a
/// crossing of two edges, whose depth is piecewise linear, two guesses do.
EdgeDepth deepestNear(const KnownField& field, const EdgeInField& edge, int k, double tolerance)
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

}  // namespace

EdgeInField placeEdge(const SurfaceSamples& samples, std::int32_t edge,
                      const FieldFromSamples& pose, const KnownField& field)
{
    const auto [a, b] = samples.edges[edge];
    const Vec3 start = pose * samples.vertices.col(a);
    const Vec3 end = pose * samples.vertices.col(b);
    const double length = samples.edgeLengths[edge];
    const int steps = std::max(2, static_cast<int>(std::ceil(length / (kStep * field.spacing()))));
    return {start, (end - start) / steps, steps, length / steps};
}

double edgeLimit(const KnownField& field, double phiStart, double phiEnd, double tau)
{
    return std::min(tau, std::min(phiStart, phiEnd) - kDeeperThanEnds * field.spacing());
}

void sampleEdge(const KnownField& field, const EdgeInField& edge, double phiStart, double limit,
                std::vector<EdgeDepth>& found)
{
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

double lowerBoundAlong(const KnownField& field, const EdgeInField& edge, double enough)
{
    const double finest = 0.125 * field.spacing() / edge.stepLength;  // in lattice steps
    double bound = std::numeric_limits<double>::infinity();
    double t = 0.0, phi = field.value(edge.start);
    while (t < edge.steps) {
        const double step = std::max(finest, std::max(0.5 * phi, phi - enough) / edge.stepLength);
        const double next = std::min(t + step, static_cast<double>(edge.steps));
        const double phiNext = field.value(edge.at(next));
        bound = std::min(bound, 0.5 * (phi + phiNext - (next - t) * edge.stepLength));
        t = next;
        phi = phiNext;
    }
    return bound;
}

}  // namespace scree
