// A variant of a shot that goes on from a frame of another take instead of from time zero.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/scene/world.h"
#include "io/shot.h"
#include "io/take_info.h"

namespace scree {

class TakeReader;

/// Where to branch off: the variant begins with the frames of `take` up to and with `frame`.
struct TakeBranch {
    std::filesystem::path take;
    int frame = 0;
};

/// "takes/a@1080" → both parts. Throws Error{usage}.
TakeBranch parseBranch(const std::string& text);

/// Looks at all that a branch needs before anything of the new take is touched: reads every frame
/// that is to be copied. `world` stands at time zero and `info` is the new take's. The two shots
/// may differ in settings only: Error{badInput} says which body, mass, mesh, frame rate or
/// beginning is another; Error{missingInput} and Error{inputOutput} name a frame that is missing or
/// damaged.
void checkBranch(const TakeBranch& branch, const Shot& shot, const World& world,
                 const TakeInfo& info);

/// What to tell of bodies whose keys say that they stand elsewhere when the branch begins than the
/// frame has them: the first step takes them there through whatever is in the way. Empty when all
/// stand right.
std::string jumpAtBranch(const TakeBranch& branch, const Shot& shot, const World& world);

/// The bytes of a frame of the branch's take as a frame of the shot. In the last one, where bodies
/// are to feel other settings from there on, those that had fallen asleep are awake.
std::string readBranchFrame(const TakeReader& from, const TakeBranch& branch, int frame,
                            const Shot& shot);

/// The lines of stats.jsonl of the frames up to the branch, by number.
std::map<int, std::string> readBranchStats(const TakeBranch& branch);

}  // namespace scree
