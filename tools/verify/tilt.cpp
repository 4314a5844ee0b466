#include "tools/verify/tilt.h"

#include <cmath>

#include "core/math/rotation.h"

namespace scree::verify {
namespace {

constexpr double kRate = 240.0;  // steps a second

}  // namespace

double tiltNow(const ShotRun& run)
{
    const Vec3 along = run.world.worldFromAsset(run.body("plank")).orientation * Vec3::UnitX();
    return -std::asin(along.y()) * 180.0 / kPi;
}

Curve tiltOver(ShotRun& run, double seconds)
{
    Curve curve;
    run.advance(seconds, kRate, [&](const StepReport&, double t) {
        curve.x.push_back(t);
        curve.y.push_back(tiltNow(run));
    });
    return curve;
}

double tiltAt(const Curve& curve, double seconds)
{
    return curve.y.at(static_cast<std::size_t>(std::lround(kRate * seconds)) - 1);
}

}  // namespace scree::verify
