// What a resume makes good before it goes on: what the shot tells again, and what can be copied
// from the take that this one was branched off. All this after the proof (take_proof.h); frames
// that this shot can simulate are left to the run.
#pragma once

#include <optional>
#include <set>

#include "core/scene/world.h"
#include "io/shot.h"
#include "io/stats_file.h"
#include "io/take_folder.h"
#include "io/take_info.h"
#include "io/take_proof.h"

namespace scree {

/// Writes a take.json that is not there or lacks something that `now` has: a list that lost bodies
/// would be read with frames that hold all of them.
void restoreInfo(const TakePaths& paths, const TakeInfo& now, ProvenTake& take);

/// Frames that another shot simulated cannot be made again by this one: those that are not whole,
/// because the copying was interrupted or one was damaged since, are copied from their take, with
/// their lines of statistics. Throws Error{missingInput} or Error{badInput} when that take is gone
/// or is not what it was.
void completeBranch(const TakePaths& paths, const Shot& shot, const TakeInfo& info,
                    std::set<int>& wholeFrames, StatsFile& stats);

/// The moment at which a run was stopped on the way to a frame that is missing; nothing when there
/// is no such checkpoint, or it is damaged. One that leads nowhere is removed.
std::optional<Clock> findCheckpoint(const TakePaths& paths, const Shot& shot, const World& world,
                                    ProvenTake& take);

}  // namespace scree
