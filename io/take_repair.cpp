#include "io/take_repair.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "io/file_bytes.h"
#include "io/frame_file.h"
#include "io/take_branch.h"
#include "io/take_reader.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

/// But for the mass, which follows from mesh and material.
bool isSame(const TakeBody& a, const TakeBody& b)
{
    return a.name == b.name && a.shape == b.shape && a.isPlane == b.isPlane &&
           a.material == b.material && a.kind == b.kind && a.isVisible == b.isVisible;
}

void copyBranchFrames(const TakePaths& paths, const Shot& shot, const TakeInfo& info,
                      const std::vector<int>& missing, StatsFile& stats)
{
    const TakeBranch branch{info.branchTake, info.branchFrame};
    const TakeReader from(branch.take);
    if (hashText(readBranchFrame(from, branch, branch.frame, shot)) != info.branchHash)
        throw Error(ErrorKind::badInput,
                    "\"" + branch.take.string() + "\" is not what it was when the take was begun");
    // Statistics first, as in writeFrame.
    std::map<int, std::string> lines = readBranchStats(branch);
    std::erase_if(
        lines, [&](const auto& line) { return !std::ranges::binary_search(missing, line.first); });
    stats.adopt(lines);
    stats.rewrite();
    for (const int frame : missing)
        writeFileBytes(paths.frame(frame), readBranchFrame(from, branch, frame, shot));
}

}  // namespace

void restoreInfo(const TakePaths& paths, const TakeInfo& now, ProvenTake& take)
{
    TakeInfo& info = take.info;
    const bool hasAll = info.bodies.size() == now.bodies.size() &&
                        info.shapes.size() == now.shapes.size() &&
                        std::ranges::equal(info.bodies, now.bodies, isSame);
    if (hasAll && isThere(paths.info()) && isJson(readFileBytes(paths.info()))) return;
    info.bodies = now.bodies;
    info.shapes = now.shapes;
    writeFileBytes(paths.info(), encodeTakeInfo(info));
    if (hasAll) return;
    take.notices.push_back(
        "\"" + paths.info().string() +
        "\" named other bodies or meshes than its shot has; the list is put right");
}

void completeBranch(const TakePaths& paths, const Shot& shot, const TakeInfo& info,
                    std::set<int>& wholeFrames, StatsFile& stats)
{
    if (info.branchTake.empty()) return;
    std::vector<int> missing;
    for (int frame = shot.firstFrame; frame <= info.branchFrame; ++frame)
        if (!wholeFrames.contains(frame)) missing.push_back(frame);
    if (missing.empty()) return;
    try {
        copyBranchFrames(paths, shot, info, missing, stats);
        wholeFrames.insert(missing.begin(), missing.end());
    } catch (const Error& problem) {
        if (problem.kind() != ErrorKind::missingInput && problem.kind() != ErrorKind::badInput)
            throw;
        throw Error(problem.kind(),
                    "frame " + std::to_string(missing.front()) + " of \"" + paths.root.string() +
                        "\" is missing or damaged, and the take was branched off "
                        "after it: " +
                        problem.what() + "; --from TAKE@" + std::to_string(info.branchFrame) +
                        " says where it stands now, or begins again with "
                        "--overwrite");
    }
}

std::optional<Clock> findCheckpoint(const TakePaths& paths, const Shot& shot, const World& world,
                                    ProvenTake& take)
{
    if (!isThere(paths.checkpoint())) return {};
    try {
        const FrameState state = readFrameFile(paths.checkpoint());
        const bool fits =
            state.shotHash == take.info.shotHash && state.motion.size() == world.bodyCount();
        // Alone a frame file cannot tell: those of method `paper` remember nothing.
        const bool remembers = shot.settings.method == Method::paper || state.clock.subStep == 0 ||
                               state.contactMemory.dt > 0.0;
        if (fits && !remembers)
            throw Error(ErrorKind::inputOutput, {paths.checkpoint().string(), 0, 0},
                        "does not remember the step that ends there");
        if (fits && !take.wholeFrames.contains(state.scene.frame + 1)) return state.clock;
        fs::remove(paths.checkpoint());
    } catch (const Error& problem) {
        std::error_code code;
        if (problem.kind() == ErrorKind::inputOutput) fs::remove(paths.checkpoint(), code);
        take.notices.push_back(std::string(problem.what()) +
                               "; going on from the last whole frame");
    }
    return {};
}

}  // namespace scree
