#include "tools/verify/tilt.h"

#include <cmath>

#include "core/math/rotation.h"

namespace scree::verify {
namespace {

constexpr double kRate = 240.0;  // steps a second

}  // namespace

Curve tiltOver(ShotRun& run, double seconds)
{
    Curve curve;
    const BodyId plank = run.body("plank");
    run.advance(seconds, kRate, [&](const StepReport&, double t) {
        const Vec3 along = run.world.worldFromAsset(plank).orientation * Vec3::UnitX();
        curve.x.push_back(t);
        curve.y.push_back(-std::asin(along.y()) * 180.0 / kPi);
    });
    return curve;
}

double tiltAt(const Curve& curve, double seconds)
{
    return curve.y.at(static_cast<std::size_t>(std::lround(kRate * seconds)) - 1);
}

}  // namespace scree::verify
