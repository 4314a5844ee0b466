#include "io/take.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/base/check.h"
#include "core/base/error.h"
#include "io/build_world.h"
#include "io/file_bytes.h"
#include "io/take_proof.h"
#include "io/take_removal.h"
#include "io/take_repair.h"
#include "io/take_shapes.h"
#include "io/world_state.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

/// For whoever said neither --resume nor --overwrite.
void refuseToDisturb(const TakePaths& paths, int lastFrame)
{
    const std::vector<int> frames = listFrames(paths);
    const std::string name = "\"" + paths.root.string() + "\"";
    if (!isThere(paths.info())) {
        if (frames.empty()) return;
        throw Error(ErrorKind::inputOutput,
                    name +
                        " has frames but no take.json: --resume makes it again if they are of "
                        "this shot, --overwrite begins again, -o writes elsewhere");
    }
    const bool finished = !frames.empty() && frames.back() >= lastFrame;
    throw Error(ErrorKind::cannotCreate,
                name + (finished ? " holds a finished take: --overwrite replaces it, -o writes "
                                   "elsewhere, --resume checks it and fills gaps"
                                 : " holds an unfinished take: --resume goes on with it, "
                                   "--overwrite begins again"));
}

}  // namespace

TakeWriter::TakeWriter(const fs::path& folder, const Shot& shot, const World& world,
                       const std::string& programVersion, ExistingTake existing,
                       const std::optional<TakeBranch>& branch)
    : shot_(shot), paths_{folder}, stats_(paths_.stats())
{
    // Look at everything before anything is touched.
    if (branch) refuseBranchOffItself(*branch, folder);
    refuseForeignFiles(paths_);
    if (existing == ExistingTake::refuse) refuseToDisturb(paths_, shot_.lastFrame);
    const bool isTake = holdsTake(paths_);
    const bool goesOn = isTake && existing == ExistingTake::resume;
    const SceneDescription scene = describeScene(shot_, world, 1.0);
    TakeInfo info = makeTakeInfo(shot_, world, scene, programVersion);
    info.shapes = shapesOf(scene);
    if (branch && !goesOn) recordBranch(*branch, shot_, world, info, notices_);

    createFolder(folder);
    lock_.emplace(paths_);
    // Whoever was here before the lock may have made a take meanwhile.
    if (existing == ExistingTake::refuse) refuseToDisturb(paths_, shot_.lastFrame);
    if (isTake != holdsTake(paths_))
        throw Error(ErrorKind::cannotCreate,
                    "\"" + folder.string() + "\" was written by another scree sim just now");
    removeTemporaries(paths_);
    if (existing == ExistingTake::overwrite) removeTake(paths_);
    if (goesOn)
        resume(world, scene, info, branch);
    else
        start(scene, info);
}

/// The description comes first: from then on a resume knows what this take is to be, whatever
/// instant the writer is killed at, and makes good all that is missing.
void TakeWriter::start(const SceneDescription& scene, const TakeInfo& info)
{
    // What a take that was removed may have left behind must not be taken for this one's.
    std::error_code ignored;
    for (const fs::path& path : {paths_.checkpoint(), paths_.stats()}) fs::remove(path, ignored);
    writeFileBytes(paths_.info(), encodeTakeInfo(info));
    writeShapes(paths_, scene);
    createFolder(paths_.frames());
    // A line appended to what is not there yet would be durable under a name that is not.
    stats_.rewrite();
    completeBranch(paths_, shot_, info, wholeFrames_, stats_);
}

void TakeWriter::resume(const World& world, const SceneDescription& scene, const TakeInfo& now,
                        const std::optional<TakeBranch>& branch)
{
    ProvenTake take = proveTake(paths_, shot_, world, now, branch);
    restoreInfo(paths_, now, take);
    for (const fs::path& damaged : writeShapes(paths_, scene))
        take.notices.push_back("\"" + damaged.string() + "\" was damaged; it is written again");
    createFolder(paths_.frames());
    // Statistics follow the frames: lines of frames that are gone or damaged go too.
    stats_.readLinesOf(take.wholeFrames);
    completeBranch(paths_, shot_, take.info, take.wholeFrames, stats_);
    checkpoint_ = findCheckpoint(paths_, shot_, world, take);
    stats_.rewrite();
    wholeFrames_ = std::move(take.wholeFrames);
    notices_ = std::move(take.notices);
    const auto untold =
        std::ranges::count_if(wholeFrames_, [&](int frame) { return !stats_.hasLine(frame); });
    if (untold > 0)
        notices_.push_back("\"" + paths_.stats().string() + "\" has no figures for " +
                           std::to_string(untold) +
                           " frames that are there: whether their overlap broke a limit is no "
                           "longer known");
}

std::optional<FrameState> TakeWriter::prepareFor(int frame, World& world) const
{
    const std::int64_t previous = frame - 1 - shot_.firstFrame;
    const bool fromCheckpoint = checkpoint_ && checkpoint_->frame == previous;
    const bool standsThere = world.clock.frame == previous &&
                             !(fromCheckpoint && world.clock.subStep < checkpoint_->subStep);
    if (standsThere) return {};
    FrameState state =
        readFrameFile(fromCheckpoint ? paths_.checkpoint() : paths_.frame(frame - 1));
    restoreState(world, state);
    // The samples in a frame's own file lie on the way to it, not from it.
    if (!fromCheckpoint) state.between.clear();
    return state;
}

void TakeWriter::writeFrame(const World& world, const FrameStats& stats,
                            const std::vector<SceneFrame>& between,
                            const std::optional<StepSeen>& lastStep,
                            const std::vector<BodyPair>& untold)
{
    FrameState state = captureState(shot_, world, between);
    state.lastStep = lastStep;
    state.untold = untold;
    SCREE_CHECK(state.scene.frame == stats.frame && world.clock.subStep == 0,
                "a frame is written at its boundary");

    // Statistics first: a line without its frame is dropped by the next resume, a frame without its
    // line would stay so.
    stats_.add(stats.frame, encodeStats(stats, world));
    writeFileBytes(paths_.frame(stats.frame), encodeFrame(state));
    wholeFrames_.insert(stats.frame);

    // A checkpoint that led here has done its duty: the frame itself is the place to go on from.
    if (!checkpoint_ || checkpoint_->frame >= world.clock.frame) return;
    std::error_code code;
    fs::remove(paths_.checkpoint(), code);
    checkpoint_.reset();
}

void TakeWriter::writeCheckpoint(const World& world, const std::vector<SceneFrame>& between,
                                 const FrameReport& soFar, const std::vector<BodyPair>& untold)
{
    FrameState state = captureState(shot_, world, between);
    state.soFar = soFar;
    state.untold = untold;
    writeFileBytes(paths_.checkpoint(), encodeFrame(state));
    checkpoint_ = world.clock;
}

std::vector<FrameSummary> TakeWriter::summaries() const
{
    return readStats(paths_.stats());
}

}  // namespace scree
