// Reads a take without its shot: what render and the exporters need stands in it.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/picture/scene_description.h"
#include "io/frame_file.h"
#include "io/frame_stats.h"
#include "io/take_folder.h"
#include "io/take_info.h"

namespace scree {

class TakeReader {
public:
    /// Throws Error{missingInput} when the folder is no take, Error{inputOutput} when take.json is
    /// damaged.
    explicit TakeReader(const std::filesystem::path& folder);

    const TakeInfo& info() const { return info_; }
    const TakePaths& paths() const { return paths_; }

    /// Frames that have a file, ascending.
    const std::vector<int>& frames() const { return frames_; }

    /// How large the squares are that stand for planes: as the action, for which all frames have to
    /// be read, or anyhow, for those who draw planes without end.
    enum class PlaneSize { ofAction, any };

    /// Bodies and meshes, in the shot's unit. Throws when a mesh is missing or damaged.
    SceneDescription describe(PlaneSize planes = PlaneSize::ofAction) const;

    /// Throws Error{missingInput} when the frame was not simulated, Error{inputOutput} when its
    /// file is damaged.
    SceneFrame readFrame(int frame) const;

    /// The same with the state that a run goes on from.
    FrameState readState(int frame) const;

    /// Calls visit(number, frame) for those of the frames that are whole: whoever wants one that is
    /// damaged is told so.
    void forWholeFrames(const std::vector<int>& numbers,
                        const std::function<void(int, const SceneFrame&)>& visit) const;

    /// Offsets of the samples around every frame [frames], ascending, 0 among them.
    const std::vector<double>& offsets() const { return info_.offsets; }

    /// The frame and its sub-frame samples, one for each of offsets(). Where nothing was simulated,
    /// before the first and after the last frame, bodies coast. Throws as readFrame does.
    std::vector<SceneFrame> readSamples(int frame) const;

    /// What the step that ended at the frame did (SI), where the shot asked for it with
    /// output.contacts; nothing at the first frame, which no step led to. Throws as readFrame does.
    std::optional<StepSeen> readLastStep(int frame) const { return readState(frame).lastStep; }

    /// Those of frames() that are cut, damaged or of another take, and what is wrong with each.
    /// Reads them all; `beforeFrame` is called before each and may throw to break off.
    std::map<int, std::string> damagedFrames(const std::function<void()>& beforeFrame = {}) const;

    std::vector<FrameSummary> stats() const { return readStats(paths_.stats()); }

private:
    void tellBirths(SceneDescription& scene) const;
    double planeHalfWidth(const SceneDescription& scene) const;

    TakePaths paths_;
    TakeInfo info_;
    std::vector<int> frames_;
};

}  // namespace scree
