// Symbols: s relative speed of two surfaces, l inner thickness, alpha share of it passed in a step.
#include "core/dynamics/step_limit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/dynamics/integrator.h"

namespace scree {
namespace {

constexpr double kAlphaPerSafety = 0.5;  // [A16]

double thickness(const World& world, BodyId body)
{
    const Shape& shape = world.shapeOf(body);
    return shape.isPlane ? std::numeric_limits<double>::infinity() : shape.innerThickness;
}

double surfaceSpin(const World& world, BodyId body)
{
    if (!world.mass[body].isMovable()) return 0.0;
    return angularVelocity(world.motion[body], world.mass[body]).norm() *
           world.shapeOf(body).boundingRadius;
}

/// The dt with s dt + g dt² = length.
double timeToPass(double length, double s, double g)
{
    if (g <= 0.0) return s > 0.0 ? length / s : std::numeric_limits<double>::infinity();
    return 2.0 * length / (s + std::sqrt(s * s + 4.0 * g * length));
}

void tighten(StepLength& limit, double dt, StepLimit by, BodyId body)
{
    if (dt < limit.dt) limit = {dt, by, body, false};
}

}  // namespace

StepLength chooseStep(const World& world, const StepSettings& settings, double frameDuration,
                      double remaining, const StepScratch& scratch)
{
    const double g = settings.gravity.norm();
    const double alpha = kAlphaPerSafety * settings.substeps.safety;
    StepLength limit{remaining, StepLimit::frame, -1, false};
    for (std::size_t i = 0; i < scratch.pairCount; ++i) {
        const auto [a, b] = scratch.pairs[i].bodies;
        const double thinner = std::min(thickness(world, a), thickness(world, b));
        const double s = (world.motion[a].velocity - world.motion[b].velocity).norm() +
                         surfaceSpin(world, a) + surfaceSpin(world, b);
        const bool bothFall = world.mass[a].isMovable() && world.mass[b].isMovable();
        const BodyId faster =
            world.motion[a].velocity.norm() >= world.motion[b].velocity.norm() ? a : b;
        tighten(limit, timeToPass(alpha * thinner, s, bothFall ? 0.0 : g), StepLimit::relativeSpeed,
                faster);
        if (g > 0.0 && settings.method == Method::paper) {
            tighten(limit, std::sqrt(settings.hoverLimit * thinner / g), StepLimit::hover, faster);
        }
    }
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        if (!world.mass[b].isMovable()) continue;
        const double spin = angularVelocity(world.motion[b], world.mass[b]).norm();
        if (spin > 0.0) {
            tighten(limit, settings.maximumSpinPerStep / spin, StepLimit::spin,
                    static_cast<BodyId>(b));
        }
    }

    const double longest = frameDuration / std::max(settings.substeps.min, 1);
    if (limit.dt > longest) limit = {longest, StepLimit::frame, -1, false};
    const double shortest = frameDuration / settings.substeps.max;
    if (limit.dt < shortest) {
        limit.dt = shortest;
        limit.limitedBy = StepLimit::substepCap;
        limit.capReached = true;
    }
    // Equal steps to the end of the frame; a hair of tolerance keeps rounding from adding one.
    const double steps = std::max(1.0, std::ceil(remaining / limit.dt - 1e-9));
    limit.dt = remaining / steps;
    return limit;
}

}  // namespace scree
