// Turns motion that comes frame by frame into motion body by body.
//
// USD and glTF store all times of one body together. Keeping them in memory would tie the length of
// a shot to the memory of the machine, so samples wait in a spool file, and blocks of bodies are
// gathered from it at the end.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "core/picture/scene_description.h"
#include "io/spool_file.h"

namespace scree {

/// What one body does at one time.
struct MotionSample {
    Pose worldFromAsset;
    Vec3 velocity = Vec3::Zero();         ///< of the asset's origin, units per second
    Vec3 angularVelocity = Vec3::Zero();  ///< world axes [rad/s]
};

/// Orientations are given back as unit quaternions, each in the hemisphere of the one before, so
/// that readers which interpolate them component by component go the short way too.
class MotionSpool {
public:
    /// Keeps the motion of `bodies` (indices into the scene) in a nameless file in `folder`; takes
    /// about `blockBytes` of memory when it gives tracks back.
    MotionSpool(const std::filesystem::path& folder, std::vector<std::size_t> bodies,
                std::size_t blockBytes = std::size_t{64} << 20);

    /// Frames come in the order of their times. Throws Error{inputOutput} when the disk refuses.
    void append(const SceneFrame& frame);

    const std::vector<std::size_t>& bodies() const { return bodies_; }

    /// Of the samples so far, in frames; parts of a frame are between two frames.
    const std::vector<double>& times() const { return times_; }

    /// All bodies at one time, parallel to bodies().
    std::vector<MotionSample> readTime(std::size_t time);

    /// Calls visit(k, track) for every body bodies()[k] in order; track is parallel to times().
    void visitTracks(
        const std::function<void(std::size_t k, std::span<const MotionSample> track)>& visit);

private:
    std::vector<std::size_t> bodies_;
    std::size_t blockBytes_;
    std::vector<Quat> lastOrientation_;
    std::vector<double> times_;
    SpoolFile spool_;
};

/// The times of a track that a reader needs; linear interpolation gives it the others exactly.
/// `isSame(i, j)` compares two of `count` samples. One time is left when nothing changes.
std::vector<std::size_t> neededTimes(
    std::size_t count, const std::function<bool(std::size_t i, std::size_t j)>& isSame);

}  // namespace scree
