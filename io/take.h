// The take: the truth on disk. A folder that only `scree sim` writes; whatever instant the writer
// is killed at, what stands in it is whole, and going on from there gives the bits of a run that
// was never interrupted. What a resume asks of a take stands in take_proof.h, what it makes good in
// take_repair.h.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/picture/scene_description.h"
#include "core/scene/world.h"
#include "io/frame_file.h"
#include "io/frame_stats.h"
#include "io/shot.h"
#include "io/stats_file.h"
#include "io/take_branch.h"
#include "io/take_folder.h"
#include "io/take_info.h"

namespace scree {

/// What to do when the folder already holds a take.
enum class ExistingTake {
    refuse,     ///< say so and stop
    resume,     ///< go on where it ends; start when there is none
    overwrite,  ///< remove it, and what was made from it, and begin again
};

/// Writes frames one by one. Holds a lock on the folder, so that two writers cannot meet.
///
/// Frames need not come in order: a damaged file in the middle of a take is a hole, and only the
/// hole is simulated again. The next frame to simulate is the first for which hasFrame() is false.
class TakeWriter {
public:
    /// `world`, built from `shot`, stands at time zero; `shot` must outlive the writer. Throws
    /// Error{cannotCreate} when the folder is taken and may not be touched, Error{badInput} when it
    /// belongs to another shot, Error{inputOutput} when take.json is lost or damaged and its frames
    /// do not tell that they are of this shot.
    ///
    /// A new take with a `branch` begins with the frames of another (io/take_branch.h), which are
    /// looked at before anything in the folder is touched: throws as recordBranch does, and
    /// Error{usage} when the other is this very take. One that is resumed knows where it was
    /// branched off; a `branch` then only says where that take stands now, and Error{badInput}
    /// tells when it names another frame, or the take was never branched off.
    TakeWriter(const std::filesystem::path& folder, const Shot& shot, const World& world,
               const std::string& programVersion, ExistingTake existing,
               const std::optional<TakeBranch>& branch = std::nullopt);

    const TakePaths& paths() const { return paths_; }

    /// What was found damaged or odd while resuming or branching off, one sentence each.
    const std::vector<std::string>& notices() const { return notices_; }

    /// Whether a whole frame file stands there.
    bool hasFrame(int frame) const { return wholeFrames_.contains(frame); }
    int lastWholeFrame() const { return wholeFrames_.empty() ? 0 : *wholeFrames_.rbegin(); }

    /// Makes `world` ready to simulate towards `frame`, whose predecessor must exist: nothing to do
    /// when it stands there already, else from the checkpoint inside that frame or the frame
    /// before. Returns what it was made from: `between` are the sub-frame samples that were met so
    /// far on the way to `frame`, `soFar` the figures of that way.
    std::optional<FrameState> prepareFor(int frame, World& world) const;

    /// Stores the frame `world` has reached with the sub-frame samples of the way there; drops the
    /// checkpoint that led to it. `lastStep`: what the step that ended here did, if it is wanted.
    /// `untold`: as in FrameState.
    void writeFrame(const World& world, const FrameStats& stats,
                    const std::vector<SceneFrame>& between = {},
                    const std::optional<StepSeen>& lastStep = {},
                    const std::vector<BodyPair>& untold = {});

    /// Stores `world` between two sub-steps. `soFar`: the figures of those that led there from the
    /// frame before; `untold`: that frame's.
    void writeCheckpoint(const World& world, const std::vector<SceneFrame>& between = {},
                         const FrameReport& soFar = {}, const std::vector<BodyPair>& untold = {});

    /// What stats.jsonl says of the frames, ascending.
    std::vector<FrameSummary> summaries() const;

private:
    void start(const SceneDescription& scene, const TakeInfo& info);
    void resume(const World& world, const SceneDescription& scene, const TakeInfo& now,
                const std::optional<TakeBranch>& branch);

    const Shot& shot_;
    TakePaths paths_;
    std::optional<TakeLock> lock_;
    std::set<int> wholeFrames_;
    std::optional<Clock> checkpoint_;  // of the checkpoint file, if whole
    StatsFile stats_;
    std::vector<std::string> notices_;
};

}  // namespace scree
