// The take: the truth on disk. A folder that only `scree sim` writes; whatever instant the writer
// is killed at, what stands in it is whole, and going on from there gives the bits of a run that
// was never interrupted.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/scene/world.h"
#include "io/frame_file.h"
#include "io/frame_stats.h"
#include "io/shot.h"
#include "io/take_branch.h"
#include "io/take_info.h"

namespace scree {

/// Where the parts of a take stand.
struct TakePaths {
    std::filesystem::path root;

    std::filesystem::path info() const { return root / "take.json"; }
    std::filesystem::path stats() const { return root / "stats.jsonl"; }
    std::filesystem::path statsPage() const { return root / "stats.html"; }
    std::filesystem::path checkpoint() const { return root / "checkpoint.scree"; }
    std::filesystem::path lock() const { return root / ".lock"; }
    std::filesystem::path images() const { return root / "images"; }
    std::filesystem::path exports() const { return root / "exports"; }
    std::filesystem::path shapes() const { return root / "shapes"; }
    std::filesystem::path shape(const std::string& name) const
    {
        return shapes() / (name + ".ply");
    }
    std::filesystem::path frames() const { return root / "frames"; }
    std::filesystem::path frame(int frame) const;
};

/// The number in "frame.001001.scree"; nothing for any other name.
std::optional<int> frameNumber(const std::string& name);

/// Throws Error{cannotCreate} when `output` is one of the files that the take around it consists
/// of: what is made from a take must not replace it.
void refuseTakeFile(const std::filesystem::path& output);

/// Numbers of the frame files that stand in the take, whole or not, ascending.
std::vector<int> listFrames(const TakePaths& paths);

/// The state of `world` with the poses that follow from it, and the samples met on the way there.
FrameState captureState(const Shot& shot, const World& world, std::vector<SceneFrame> between = {});

/// Gives `world`, built from the same shot, the state it had when `state` was captured.
void restoreState(World& world, const FrameState& state);

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
    /// looked at before anything in the folder is touched: throws as checkBranch does, and
    /// Error{usage} when the other is this very take. One that is resumed knows where it was
    /// branched off; a `branch` then only says where that take stands now, and Error{badInput}
    /// tells when it names another frame, or the take was never branched off.
    TakeWriter(const std::filesystem::path& folder, const Shot& shot, const World& world,
               const std::string& programVersion, ExistingTake existing,
               const std::optional<TakeBranch>& branch = std::nullopt);
    ~TakeWriter();
    TakeWriter(const TakeWriter&) = delete;
    TakeWriter& operator=(const TakeWriter&) = delete;

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
    bool holdsTake() const;
    void refuseToDisturb(ExistingTake existing) const;
    TakeInfo describe(const World& world, const std::string& programVersion) const;
    void refuseBranchOffItself(const TakeBranch& branch) const;
    void recordBranch(const TakeBranch& branch, const World& world, TakeInfo& info);
    void start(const World& world, const TakeInfo& info);
    void resume(const World& world, const TakeInfo& now, const std::optional<TakeBranch>& branch);
    TakeInfo readInfo(const World& world, TakeInfo now, const std::optional<TakeBranch>& branch);
    void checkSameShot(const TakeInfo& info, const TakeInfo& now);
    void checkSameCast(const TakeInfo& info, const TakeInfo& now) const;
    void findWholeFrames(const World& world);
    void proveStart(const World& world) const;
    void restoreInfo(const TakeInfo& now, TakeInfo& info);
    std::vector<std::filesystem::path> writeShapes(const World& world) const;
    void completeBranch(const TakeInfo& info);
    void copyBranchFrames(const TakeInfo& info, const std::vector<int>& missing);
    void findCheckpoint(const World& world);
    void appendStats(const FrameStats& stats, const World& world);
    void rewriteStats() const;

    const Shot& shot_;
    TakePaths paths_;
    std::uint64_t shotHash_ = 0;
    int lock_ = -1;
    std::set<int> wholeFrames_;
    std::optional<Clock> checkpoint_;        // of the checkpoint file, if whole
    std::map<int, std::string> statsLines_;  // by frame
    std::vector<std::string> notices_;
};

}  // namespace scree
