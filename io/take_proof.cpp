#include "io/take_proof.h"

#include <algorithm>
#include <cstdint>
#include <map>

#include "core/base/error.h"
#include "io/file_bytes.h"
#include "io/frame_file.h"
#include "io/shot_difference.h"
#include "io/world_state.h"

namespace scree {
namespace {

/// What take.json says. Lost or unreadable it is made again, if frame by frame up to the last that
/// is there all say that they are of this shot: what might be missing between is not known to be
/// this shot's to simulate.
TakeInfo readInfo(const TakePaths& paths, const Shot& shot, const World& world, TakeInfo now,
                  const std::optional<TakeBranch>& branch, std::vector<std::string>& notices)
{
    const bool isLost = !isThere(paths.info());
    const std::string text = isLost ? std::string() : readFileBytes(paths.info());
    if (isJson(text)) return decodeTakeInfo(text, paths.info());
    const std::string name = "\"" + paths.info().string() + "\"";
    const std::string found = isLost ? " is missing" : " is damaged";
    int expected = shot.firstFrame;
    for (const int frame : listFrames(paths)) {
        const FrameState state = readFrameFile(paths.frame(frame));
        if (state.shotHash != now.shotHash)
            throw Error(ErrorKind::badInput, name + found + ", and frame " + std::to_string(frame) +
                                                 " beside it is of another shot: -o writes "
                                                 "elsewhere, --overwrite begins again");
        if (frame != expected++)
            throw Error(ErrorKind::inputOutput,
                        name + found + ", and so is frame " + std::to_string(expected - 1) +
                            ": put them back, or begin again with --overwrite");
    }
    if (branch) recordBranch(*branch, shot, world, now, notices);
    notices.push_back(name + (isLost ? " was missing" : " was damaged") +
                      "; it is made again from the shot, which its frames are of");
    return now;
}

void checkSameShot(const TakePaths& paths, const TakeInfo& info, const TakeInfo& now,
                   std::vector<std::string>& notices)
{
    const std::string name = "\"" + paths.root.string() + "\"";
    if (info.shotHash != now.shotHash)
        throw Error(
            ErrorKind::badInput,
            name + " was made from another shot: this one has " +
                someDifferences(shotDifferences(now.resolvedShot, info.resolvedShot, "the take")) +
                ". -o writes to another folder, there --from \"" + paths.root.string() +
                "@FRAME\" begins with this take's frames up to that one; --overwrite begins "
                "anew");
    for (std::size_t i = 0; i < std::min(info.inputs.size(), now.inputs.size()); ++i)
        if (info.inputs[i].hash != now.inputs[i].hash)
            throw Error(ErrorKind::badInput, name + " was made from another \"" +
                                                 now.inputs[i].path +
                                                 "\": the file has changed since");
    if (info.programVersion != now.programVersion)
        notices.push_back(name + " was begun by scree " + info.programVersion + ", this is " +
                          now.programVersion + ": the bits may differ from an unbroken run");
}

/// What take.json has of bodies and meshes must be what the shot's files make of them now. It may
/// have lost some, and what follows from the shot's text alone.
void checkSameCast(const TakePaths& paths, const TakeInfo& info, const TakeInfo& now)
{
    const auto refuse = [&](const std::string& what) {
        throw Error(ErrorKind::badInput, "\"" + paths.root.string() + "\" was made with another " +
                                             what +
                                             ": an asset or the program has changed since. "
                                             "--overwrite begins again, -o writes elsewhere");
    };
    std::map<std::string, std::uint64_t> meshes;
    for (const TakeShape& shape : now.shapes) meshes[shape.name] = shape.hash;
    for (const TakeShape& shape : info.shapes) {
        const auto mesh = meshes.find(shape.name);
        if (mesh == meshes.end() || mesh->second != shape.hash) refuse("mesh '" + shape.name + "'");
    }
    std::map<std::string, const TakeBody*> bodies;
    for (const TakeBody& body : now.bodies) bodies[body.name] = &body;
    for (const TakeBody& body : info.bodies) {
        const auto same = bodies.find(body.name);
        if (same == bodies.end() || same->second->shape != body.shape)
            refuse("body '" + body.name + "'");
    }
}

/// The same command as the one that began the take, given again, or one for another branch?
void checkSameBranch(const TakeInfo& info, const TakeBranch& branch,
                     const std::filesystem::path& root)
{
    const std::string name = "\"" + root.string() + "\"";
    if (info.branchTake.empty())
        throw Error(
            ErrorKind::badInput,
            name + " was not begun with --from: it goes on without, or -o writes elsewhere");
    if (info.branchFrame != branch.frame)
        throw Error(ErrorKind::badInput,
                    name + " was branched off at frame " + std::to_string(info.branchFrame) +
                        ", not " + std::to_string(branch.frame) + ": -o writes elsewhere");
}

std::set<int> findWholeFrames(const TakePaths& paths, const Shot& shot, const World& world,
                              std::uint64_t shotHash, std::vector<std::string>& notices)
{
    std::set<int> whole;
    for (const int frame : listFrames(paths)) {
        if (frame < shot.firstFrame || frame > shot.lastFrame) continue;
        try {
            const FrameState state = readFrameFile(paths.frame(frame));
            if (state.shotHash != shotHash || state.scene.frame != frame ||
                state.motion.size() != world.bodyCount() ||
                state.bornAt.empty() != world.births.empty())
                throw Error(ErrorKind::badInput, {paths.frame(frame).string(), 0, 0},
                            "is of another take");
            whole.insert(frame);
        } catch (const Error& problem) {
            notices.push_back(std::string(problem.what()) + "; this frame is simulated again");
        }
    }
    return whole;
}

/// This world begins where the take begins, bit for bit.
void proveStart(const TakePaths& paths, const Shot& shot, const World& world)
{
    FrameState first = readFrameFile(paths.frame(shot.firstFrame));
    first.untold.clear();  // whoever simulates found them out
    if (encodeFrame(first) != encodeFrame(captureState(shot, world)))
        throw Error(ErrorKind::badInput,
                    "\"" + paths.root.string() +
                        "\" does not begin where this shot begins: an asset or the program has "
                        "changed since. --overwrite begins again, -o writes elsewhere");
}

}  // namespace

ProvenTake proveTake(const TakePaths& paths, const Shot& shot, const World& world,
                     const TakeInfo& now, const std::optional<TakeBranch>& branch)
{
    ProvenTake take;
    take.info = readInfo(paths, shot, world, now, branch, take.notices);
    checkSameShot(paths, take.info, now, take.notices);
    checkSameCast(paths, take.info, now);
    if (branch) {
        checkSameBranch(take.info, *branch, paths.root);
        take.info.branchTake = branch->take.string();
    }
    take.wholeFrames = findWholeFrames(paths, shot, world, now.shotHash, take.notices);
    if (take.wholeFrames.contains(shot.firstFrame)) proveStart(paths, shot, world);
    return take;
}

}  // namespace scree
