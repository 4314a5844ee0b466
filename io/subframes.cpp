// Symbols: s share of the sub-step that has passed, 0 … 1.
#include "io/subframes.h"

#include <algorithm>

#include "core/dynamics/integrator.h"
#include "core/math/rotation.h"
#include "io/build_world.h"

namespace scree {
namespace {

/// `at` is `s` of a way that should lead to `expected` and leads to `end`: what else turns it does
/// so evenly.
Quat corrected(const Quat& at, const Quat& expected, const Quat& end, double s)
{
    return rotated(at, s * rotationVector(end * expected.conjugate()));
}

/// A step of dt from a to b. Orientations go the way of the step, by the angular momentum it had
/// between: the short way from one to the other is not that of what is round, nor of a blur, which
/// a step may turn by any angle (core/dynamics/step_limit.cpp). Marbles that rolled at 10 m/s
/// turned back between one sub-step and the next.
BodyMotion mixed(const BodyMotion& a, const BodyMotion& b, const BodyMass& mass,
                 OrientationUpdate update, double dt, double s)
{
    const Vec3 angularMomentum = 0.5 * (a.angularMomentum + b.angularMomentum);
    const auto turnedFor = [&](double time) {
        return predictPose(a, mass, a.velocity, angularMomentum, update, time).orientation;
    };
    BodyMotion result;
    result.position = (1.0 - s) * a.position + s * b.position;
    result.orientation = corrected(turnedFor(s * dt), turnedFor(dt), b.orientation, s);
    result.velocity = (1.0 - s) * a.velocity + s * b.velocity;
    result.angularMomentum = (1.0 - s) * a.angularMomentum + s * b.angularMomentum;
    return result;
}

/// A resting body keeps its very bits, so that its samples are stored once.
bool isSamePlace(const BodyMotion& a, const BodyMotion& b)
{
    return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs();
}

}  // namespace

bool areSampleOffsets(const std::vector<double>& asked)
{
    const std::vector<double> offsets = sampleOffsets(asked);
    for (std::size_t i = 1; i < offsets.size(); ++i)
        if (offsets[i] - offsets[i - 1] < kLeastSampleDistance) return false;
    return offsets.back() - offsets.front() <= 1.0 - kLeastSampleDistance;
}

std::vector<double> sampleOffsets(const std::vector<double>& asked)
{
    std::vector<double> offsets = asked;
    if (std::find(offsets.begin(), offsets.end(), 0.0) == offsets.end()) offsets.push_back(0.0);
    std::sort(offsets.begin(), offsets.end());
    return offsets;
}

std::vector<double> instantsBetween(const std::vector<double>& offsets)
{
    std::vector<double> instants;
    for (const double offset : offsets)
        if (offset != 0.0) instants.push_back(offset > 0.0 ? offset : 1.0 + offset);
    std::sort(instants.begin(), instants.end());
    return instants;
}

SubframeRecorder::SubframeRecorder(const Shot& shot, const World& world)
    : shot_(shot), instants_(instantsBetween(sampleOffsets(shot.output.subframes)))
{
    if (!instants_.empty()) inBetween_ = world;
}

void SubframeRecorder::begin(const World& world, std::vector<SceneFrame> passed)
{
    samples_ = std::move(passed);
    if (instants_.empty()) return;
    before_ = world.motion;
    timeBefore_ = world.clock.frameTimeDone;
    inBetween_->restoreBirths(world.bornAt);
}

void SubframeRecorder::afterStep(const World& world, double frameTime)
{
    if (instants_.empty()) return;
    while (samples_.size() < instants_.size()) {
        const double instant = instants_[samples_.size()];
        const double time = instant / shot_.framesPerSecond;
        if (time > frameTime) break;
        samples_.push_back(sampleAt(world, frameTime, time));
        samples_.back().offset = instant;
    }
    before_ = world.motion;
    timeBefore_ = frameTime;
}

SceneFrame SubframeRecorder::sampleAt(const World& world, double frameTime, double time)
{
    const double dt = frameTime - timeBefore_, share = (time - timeBefore_) / dt;
    const OrientationUpdate update = shot_.settings.orientation;
    inBetween_->clock = world.clock;
    for (std::size_t i = 0; i < world.motion.size(); ++i) {
        const BodyMotion &a = before_[i], &b = world.motion[i];
        BodyMotion& motion = inBetween_->motion[i];
        motion = isSamePlace(a, b) ? b : mixed(a, b, world.mass[i], update, dt, share);
        // No step is shortened for what is keyed: a propeller may turn half round in one.
        if (world.info[i].kind != BodyKind::keyed || isSamePlace(a, b)) continue;
        const Pose pose = world.scriptedPose(static_cast<BodyId>(i), world.time(time - frameTime));
        motion.position = pose.position;
        motion.orientation = pose.orientation;
    }
    return captureFrame(shot_, *inBetween_);
}

SceneFrame inBetween(const SceneFrame& from, const SceneFrame& to, double share, double seconds)
{
    SceneFrame result = from;
    for (std::size_t body = 0; body < from.worldFromAsset.size(); ++body) {
        const Pose &a = from.worldFromAsset[body], &b = to.worldFromAsset[body];
        const Vec3 turn = 0.5 * seconds * (from.angularVelocity[body] + to.angularVelocity[body]);
        result.worldFromAsset[body] = {
            (1.0 - share) * a.position + share * b.position,
            corrected(rotated(a.orientation, share * turn), rotated(a.orientation, turn),
                      b.orientation, share)};
    }
    return result;
}

SceneFrame coasted(const SceneFrame& frame, double seconds)
{
    SceneFrame result = frame;
    for (std::size_t body = 0; body < frame.worldFromAsset.size(); ++body) {
        Pose& pose = result.worldFromAsset[body];
        pose.position += seconds * frame.velocity[body];
        if (!frame.angularVelocity[body].isZero(0.0))
            pose.orientation = rotated(pose.orientation, seconds * frame.angularVelocity[body]);
    }
    return result;
}

}  // namespace scree
