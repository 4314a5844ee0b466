// A variant of a shot that goes on from a frame of another take instead of from time zero.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

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

/// Throws Error{usage} when the branch's take is the folder itself: to overwrite it would be to
/// lose what the branch is to begin with.
void refuseBranchOffItself(const TakeBranch& branch, const std::filesystem::path& folder);

/// Writes into `info`, the new take's, where it is branched off, after a look at all that the
/// branch needs: before anything of the new take is touched every frame that is to be copied is
/// read. `world` stands at time zero. The two shots may differ in settings only: Error{badInput}
/// says which body, mass, mesh, frame rate or beginning is another; Error{missingInput} and
/// Error{inputOutput} name a frame that is missing or damaged. Bodies whose keys say that they
/// stand elsewhere at that frame than they do are a notice.
void recordBranch(const TakeBranch& branch, const Shot& shot, const World& world, TakeInfo& info,
                  std::vector<std::string>& notices);

/// The bytes of a frame of the branch's take as a frame of the shot. In the last one, where bodies
/// are to feel other settings from there on, those that had fallen asleep are awake.
std::string readBranchFrame(const TakeReader& from, const TakeBranch& branch, int frame,
                            const Shot& shot);

/// The lines of stats.jsonl of the frames up to the branch, by number.
std::map<int, std::string> readBranchStats(const TakeBranch& branch);

}  // namespace scree
