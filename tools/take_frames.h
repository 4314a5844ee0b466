// Which frames of a take a command works on, and what is said when the take lacks some.
#pragma once

#include <string>
#include <vector>

#include "io/take_reader.h"
#include "tools/console.h"

namespace scree {

/// For --help of the commands that work on whole takes.
inline constexpr const char* kMissingFramesHelp =
    "When the take ends before its shot and --frames does not ask for a part, what is there is "
    "made\n"
    "and the exit code is 66.\n";

/// What there is of the frames of a shot.
struct TakeFrames {
    std::vector<int> frames;
    std::string missing;  ///< frames of the shot that are not among them; empty when none is
};

/// The frames that `asked` names, as chooseFrames has it. Without `asked` that is the whole shot:
/// when its last frames are not simulated yet, a warning says so and how to go on.
TakeFrames chooseTakeFrames(const std::string& asked, const TakeReader& take, Console& console);

/// The frames of the shot before `first` and after `last`: "1016-1040", or "" when there are none.
std::string framesBeyond(const TakeInfo& info, int first, int last);

/// The frames of the shot that are not among those, which ascend: "1004,1006-1040", or "" when all
/// are.
std::string framesLacking(const TakeInfo& info, const std::vector<int>& frames);

/// The exit code of a command that made `output` of those frames. What is missing there ends with
/// an error, so that nobody takes a part for the whole; what was made stays, it may be all that is
/// wanted.
int finishTakeFrames(const TakeFrames& chosen, const std::string& output, Console& console);

}  // namespace scree
