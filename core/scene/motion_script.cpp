#include "core/scene/motion_script.h"

#include <algorithm>

#include "core/base/check.h"
#include "core/math/monotone_slope.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// What has been taken of each of the three steps when the share s of a stretch has passed:
/// cumulative Bernstein polynomials.
std::array<double, 3> sharesAt(double s)
{
    const double rest = 1.0 - s;
    return {1.0 - rest * rest * rest, s * s * (3.0 - 2.0 * s), s * s * s};
}

/// The control points of a quadratic Bézier curve cut to the shares p … q.
template <class T>
std::array<T, 3> cut(const std::array<T, 3>& c, double p, double q)
{
    const auto blossom = [&](double a, double b) -> T {
        return (1.0 - a) * (1.0 - b) * c[0] + ((1.0 - a) * b + a * (1.0 - b)) * c[1] + a * b * c[2];
    };
    return {blossom(p, p), blossom(p, q), blossom(q, q)};
}

/// Velocities at all keys from the mean velocities between them, at rest at the first and the last.
/// Each of the three numbers by itself: a hand that slides over a table and then lifts must not
/// dive into it before, as it does where only the speed is limited.
std::vector<Vec3> keyVelocities(const std::vector<MotionKey>& keys,
                                const std::vector<Vec3>& between)
{
    std::vector<Vec3> result(keys.size(), Vec3::Zero());
    for (std::size_t k = 1; k + 1 < keys.size(); ++k) {
        const double before = keys[k].time - keys[k - 1].time;
        const double after = keys[k + 1].time - keys[k].time;
        for (int i = 0; i < 3; ++i)
            result[k][i] = slopeBetween(between[k - 1][i], before, between[k][i], after);
    }
    return result;
}

}  // namespace

MotionScript::MotionScript(const std::vector<MotionKey>& keys, KeyInterpolation interpolation)
{
    SCREE_CHECK(!keys.empty(), "a script without keys");
    first_ = keys.front();
    last_ = keys.back();

    // Mean velocities from key to key; of the turn in the axes of the body, which all turns of one
    // stretch share at its key.
    std::vector<Vec3> velocity, spin;
    for (std::size_t k = 1; k < keys.size(); ++k) {
        const double duration = keys[k].time - keys[k - 1].time;
        SCREE_CHECK(duration > 0.0, "keys out of order");
        const Pose &from = keys[k - 1].pose, &to = keys[k].pose;
        const Quat turn = from.orientation.conjugate() * to.orientation;
        velocity.push_back((to.position - from.position) / duration);
        spin.push_back(rotationVector(turn) / duration);
    }
    const std::vector<Vec3> velocityAt = keyVelocities(keys, velocity);
    const std::vector<Vec3> spinAt = keyVelocities(keys, spin);

    // A third of a stretch at the velocity of each end, and between them whatever is left.
    const bool isSmooth = interpolation == KeyInterpolation::smooth;
    for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
        Stretch stretch;
        stretch.start = keys[k].time;
        stretch.duration = keys[k + 1].time - keys[k].time;
        stretch.first = keys[k].pose;
        const double third = stretch.duration / 3.0;
        stretch.d[0] = third * (isSmooth ? velocityAt[k] : velocity[k]);
        stretch.d[2] = third * (isSmooth ? velocityAt[k + 1] : velocity[k]);
        stretch.d[1] = stretch.duration * velocity[k] - stretch.d[0] - stretch.d[2];
        stretch.w[0] = third * (isSmooth ? spinAt[k] : spin[k]);
        stretch.w[2] = third * (isSmooth ? spinAt[k + 1] : spin[k]);
        const Quat turn = exponentialMap(stretch.duration * spin[k]);
        stretch.w[1] =
            rotationVector(exponentialMap(-stretch.w[0]) * turn * exponentialMap(-stretch.w[2]));
        stretches_.push_back(stretch);
    }
}

Pose MotionScript::at(double t) const
{
    if (t <= first_.time) return first_.pose;
    if (t >= last_.time) return last_.pose;
    const auto next =
        std::upper_bound(stretches_.begin(), stretches_.end(), t,
                         [](double time, const Stretch& s) { return time < s.start; });
    const Stretch& stretch = *(next - 1);
    const auto share = sharesAt((t - stretch.start) / stretch.duration);
    Pose pose = stretch.first;
    for (int i = 0; i < 3; ++i) {
        pose.position += share[i] * stretch.d[i];
        pose.orientation = pose.orientation * exponentialMap(share[i] * stretch.w[i]);
    }
    pose.orientation.normalize();
    return pose;
}

ScriptBounds MotionScript::boundsBetween(double from, double to) const
{
    ScriptBounds bounds;
    const bool holds = from < first_.time || to > last_.time || stretches_.empty();
    if (holds) bounds.velocities.push_back(Vec3::Zero());
    for (const Stretch& stretch : stretches_) {
        const double p = std::max(0.0, (from - stretch.start) / stretch.duration);
        const double q = std::min(1.0, (to - stretch.start) / stretch.duration);
        if (p > q) continue;
        std::array<double, 3> turns;
        for (int i = 0; i < 3; ++i) turns[i] = stretch.w[i].norm();
        const double rate = 3.0 / stretch.duration;
        for (const Vec3& d : cut(stretch.d, p, q)) bounds.velocities.push_back(rate * d);
        for (const double turn : cut(turns, p, q)) {
            bounds.spin = std::max(bounds.spin, rate * turn);
        }
    }
    return bounds;
}

}  // namespace scree
