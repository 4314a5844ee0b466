// A variant of a shot that goes on from a frame of another take instead of from time zero.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/scene/world.h"
#include "io/shot.h"
#include "io/take_info.h"

namespace scree {

/// Where to branch off: the variant begins with the frames of `take` up to and with `frame`.
struct TakeBranch {
    std::filesystem::path take;
    int frame = 0;
};

/// "takes/a@1080" → both parts. Throws Error{usage}.
TakeBranch parseBranch(const std::string& text);

/// Writes the frames into the folder `frames`, as frames of `shot`; returns their lines of
/// stats.jsonl by number. `world` stands at time zero and `info` is the new take's. The two shots
/// may differ in settings only: Error{badInput} says which body, mass, mesh, frame rate or
/// beginning is another, Error{missingInput} when a frame was not simulated.
std::map<int, std::string> copyBranch(const TakeBranch& branch, const Shot& shot,
                                      const World& world, const TakeInfo& info,
                                      const std::filesystem::path& root);

}  // namespace scree
