// Symbols: theta tilt, w its rate; s place of the heavy block along the plank, v its rate; t and n
//          directions along the plank, towards the heavy side, and off it.
#include "tools/verify/seesaw_theory.h"

#include <cmath>
#include <utility>

#include "core/math/rotation.h"

namespace scree::verify {
namespace {

// As in shots/verify/E05_seesaw.toml. [m], [kg]
constexpr double kGravity = 9.8, kFriction = 0.15, kPivotRadius = 0.5, kHalfPlank = 0.25;

/// A body on the plank, or the plank itself: its centre in the axes of the plank, whose origin is
/// the middle of the plank.
struct Part {
    double mass, inertia, along, above;
    bool slides;
};
constexpr Part kPlank = {10.0, 10.0 * (100.0 + 0.25) / 12.0, 0.0, 0.0, false};
constexpr Part kLight = {5.0, 5.0 / 6.0, -4.0, 0.75, false};
constexpr Part kHeavy = {20.0, 20.0 * 1.8 * 1.8 / 6.0, 3.5, 1.15, true};

/// First degree in the unknown accelerations.
struct Linear {
    double tilting, sliding, rest;

    double at(double tiltingNow, double slidingNow) const
    {
        return tilting * tiltingNow + sliding * slidingNow + rest;
    }
};

struct State {
    double theta = 0.0, w = 0.0, s = kHeavy.along, v = 0.0;
};

/// What accelerates a part along t and n, gravity taken off.
std::pair<Linear, Linear> accelerations(const Part& part, const State& now)
{
    const double v = part.slides ? now.v : 0.0;
    const double arm = kPivotRadius * now.theta - (part.slides ? now.s : part.along);
    const double ww = now.w * now.w;
    return {{kHalfPlank + part.above, part.slides ? 1.0 : 0.0,
             arm * ww - kGravity * std::sin(now.theta)},
            {arm, 0.0,
             (kPivotRadius - kHalfPlank - part.above) * ww - 2.0 * now.w * v +
                 kGravity * std::cos(now.theta)}};
}

/// What all parts together take of torque about the pivot: nothing, as they move.
Linear balance(const State& now)
{
    Linear sum{0.0, 0.0, 0.0};
    for (const Part& part : {kPlank, kLight, kHeavy}) {
        const auto [t, n] = accelerations(part, now);
        sum.tilting += part.mass * (t.tilting * t.tilting + n.tilting * n.tilting) + part.inertia;
        sum.sliding += part.mass * t.tilting * t.sliding;
        sum.rest += part.mass * (t.tilting * t.rest + n.tilting * n.rest);
    }
    return sum;
}

/// How theta and s are accelerated.
std::pair<double, double> solve(const State& now)
{
    const auto [t, n] = accelerations(kHeavy, now);
    const Linear sum = balance(now);
    const double together = -sum.rest / sum.tilting;
    const double needed = t.at(together, 0.0), most = kFriction * n.at(together, 0.0);
    if (now.v == 0.0 && std::abs(needed) <= most) return {together, 0.0};
    const double way = now.v != 0.0 ? -now.v : needed;
    const double friction = std::copysign(kFriction, way);
    // t = friction n gives the sliding by the tilting.
    const double byTilting = friction * n.tilting - t.tilting;
    const double besides = friction * n.rest - t.rest;
    const double tilting =
        -(sum.rest + sum.sliding * besides) / (sum.tilting + sum.sliding * byTilting);
    return {tilting, byTilting * tilting + besides};
}

}  // namespace

double seeSawTilt(double seconds, double stepsPerSecond)
{
    const double dt = 1.0 / stepsPerSecond;
    State now;
    for (long step = std::lround(seconds * stepsPerSecond); step > 0; --step) {
        const auto [tilting, sliding] = solve(now);
        const double before = now.v;
        now.w += dt * tilting;
        now.v += dt * sliding;
        if (before * now.v < 0.0) now.v = 0.0;
        now.theta += dt * now.w;
        now.s += dt * now.v;
    }
    return now.theta * 180.0 / kPi;
}

}  // namespace scree::verify
