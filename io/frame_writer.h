// A cache for another program, written frame by frame. One file per format implements this
// interface; the calls are begin, write for every frame in order, finish.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/picture/scene_description.h"

namespace scree {

/// Told while finish() is at work how much of it is done (0 … 1). It may throw to break off.
using FinishWatch = std::function<void(double share)>;

/// The public calls check what every format needs (names, order and completeness of frames, finite
/// poses), so that a format only writes. Nothing is visible under the output's name before
/// finish(), except in sequences, where each frame's file appears complete; a writer that is
/// destroyed earlier leaves no half cache behind.
class FrameWriter {
public:
    virtual ~FrameWriter() = default;

    /// Whether the format can hold samples between frames.
    virtual bool holdsSubframes() const { return false; }

    /// How long finish() takes, about, against all calls of write() together: what holds all times
    /// of a body in one place is written at the end.
    virtual double finishCost() const { return 0.0; }

    /// What of the scene the format cannot hold though its readers would look for it, a sentence
    /// each.
    virtual std::vector<std::string> losses(const SceneDescription& /*scene*/) const { return {}; }

    /// `frameCount` frames will follow, the first is `firstFrame`; each has one sample for every
    /// one of `offsets` [frames], which ascend within less than a frame and hold 0. A writer that
    /// holds no sub-frames takes {0} only. The scene must outlive finish().
    /// Throws Error{badInput} for a scene, body or mesh that no format could name or hold,
    /// Error{cannotCreate} when the output cannot be created.
    void begin(const SceneDescription& scene, int firstFrame, int frameCount,
               const std::vector<double>& offsets = {0.0});

    /// Frames come one after the other without gaps, samples of a frame in the order of the
    /// offsets.
    /// Throws Error{qualityLimit} naming the first body whose pose or velocity is not finite, or
    /// beyond what single precision holds.
    void write(const SceneFrame& frame);

    /// Throws Error{inputOutput} when the disk refuses, as write() may. `watch` is called often.
    void finish(const FinishWatch& watch = [](double) {});

protected:
    const std::vector<double>& offsets() const { return offsets_; }

    /// Of all samples, in order [frames].
    std::vector<double> times() const;

private:
    virtual void beginScene(const SceneDescription& scene, int firstFrame, int frameCount) = 0;
    virtual void writeFrame(const SceneFrame& frame) = 0;
    virtual void finishScene(const FinishWatch& watch) = 0;

    const SceneDescription* scene_ = nullptr;
    std::vector<double> offsets_;
    std::size_t nextSample_ = 0;  // index into offsets_
    int firstFrame_ = 0, frameCount_ = 0;
    int nextFrame_ = 0;
    int framesLeft_ = 0;
};

/// Whether there is a writer for the ending of `output`.
bool isExportable(const std::filesystem::path& output);

/// Whether that writes a file for each frame. Throws Error{usage} as makeFrameWriter does.
bool isFrameSequence(const std::filesystem::path& output);

/// The writer for the ending of `output`: "out.abc", "out.usda" and "out.instances.usda",
/// "out.glb", "out.####.obj", "out.####.ply", "out.####.pov". Throws Error{usage} for an unknown
/// ending (the message lists the known ones), for a sequence without a place for the frame number,
/// and for a single file with one.
std::unique_ptr<FrameWriter> makeFrameWriter(const std::filesystem::path& output);

/// The same for a single frame: "out.obj" and its like need no place for the frame number.
std::unique_ptr<FrameWriter> makePoseWriter(const std::filesystem::path& output);

}  // namespace scree
