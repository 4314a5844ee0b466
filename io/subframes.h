// Samples between frames, for motion blur. A shot names offsets around every frame, for instance
// −0.25, 0 and +0.25; the instants they stand for are met while the solver steps from one frame to
// the next, and a sample is read off between the two sub-steps around it. Nothing that moves bodies
// knows of it.
//
// A sample belongs to the interval in which it was met: offset +0.25 of frame f and −0.25 of frame
// f + 1 are both kept with frame f + 1 (and, while that frame is under way, in its checkpoint). So
// a frame file is complete when it is written, and a stopped run goes on to the same bytes.
#pragma once

#include <optional>
#include <vector>

#include "core/picture/scene_description.h"
#include "core/scene/world.h"
#include "io/shot.h"

namespace scree {

/// Least distance of two samples [frames]. At 24 frames per second it is 0.4 ms; Alembic's readers
/// take times closer than 0.1 ms for equal.
inline constexpr double kLeastSampleDistance = 0.01;

/// Whether a shot may ask for these: with 0 added they fit into one frame, no two too close.
bool areSampleOffsets(const std::vector<double>& asked);

/// What a shot asks for, ascending and with 0 among them: the frame itself is always a sample.
std::vector<double> sampleOffsets(const std::vector<double>& asked);

/// The instants that the offsets stand for inside the way from one frame to the next, ascending
/// [frames after the earlier one].
std::vector<double> instantsBetween(const std::vector<double>& offsets);

/// Watches the solver and keeps what it passes.
class SubframeRecorder {
public:
    /// `world` was built from `shot`, which must outlive the recorder.
    SubframeRecorder(const Shot& shot, const World& world);

    /// `world` is where the way to the next frame begins or goes on; `passed` are the samples that
    /// an earlier sitting has met on it.
    void begin(const World& world, std::vector<SceneFrame> passed);

    /// `world` has stepped; `frameTime` is the time since the frame it left [s].
    void afterStep(const World& world, double frameTime);

    /// Met so far on this way, ascending.
    const std::vector<SceneFrame>& samples() const { return samples_; }

private:
    /// At `time`, of a world that has just come to `frameTime` since the frame it left [s].
    SceneFrame sampleAt(const World& world, double frameTime, double time);

    const Shot& shot_;
    std::vector<double> instants_;
    std::vector<SceneFrame> samples_;
    std::optional<World> inBetween_;  // a second world of the same bodies, to pose; if instants
    std::vector<BodyMotion> before_;  // where the bodies were one sub-step ago
    double timeBefore_ = 0.0;
};

/// The poses a share of the way from one moment to another, `seconds` later: round as often as the
/// velocities of both tell.
SceneFrame inBetween(const SceneFrame& from, const SceneFrame& to, double share, double seconds);

/// The poses `seconds` later if every body kept the velocity it has: for samples before the first
/// and after the last frame that was simulated.
SceneFrame coasted(const SceneFrame& frame, double seconds);

}  // namespace scree
