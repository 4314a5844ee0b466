#include "tools/take_frames.h"

#include "tools/command_line.h"
#include "tools/exit_code.h"
#include "tools/shell_line.h"

namespace scree {
namespace {

std::string rangeOf(int first, int last)
{
    return std::to_string(first) + (first == last ? "" : "-" + std::to_string(last));
}

}  // namespace

TakeFrames chooseTakeFrames(const std::string& asked, const TakeReader& take, Console& console)
{
    TakeFrames chosen{chooseFrames(asked, take.frames()), ""};
    // No frame at all is an error of its own, said by whoever needs one.
    if (!asked.empty() || chosen.frames.empty()) return chosen;
    const int first = chosen.frames.front(), last = chosen.frames.back();
    chosen.missing = framesBeyond(take.info(), first, last);
    if (chosen.missing.empty()) return chosen;
    const std::string root = take.paths().root.string(), there = rangeOf(first, last);
    console.warning("\"" + root + "\" is unfinished: it holds frames " + there + " of " +
                    rangeOf(take.info().firstFrame, take.info().lastFrame) + "; " +
                    shellLine({"scree", "sim", "SHOT", "-o", root, "--resume"}) +
                    " goes on with it, --frames " + there + " asks for these alone");
    return chosen;
}

std::string framesBeyond(const TakeInfo& info, int first, int last)
{
    std::string text;
    if (first > info.firstFrame) text = rangeOf(info.firstFrame, first - 1);
    if (last < info.lastFrame)
        text += (text.empty() ? "" : ",") + rangeOf(last + 1, info.lastFrame);
    return text;
}

std::string framesLacking(const TakeInfo& info, const std::vector<int>& frames)
{
    // Run by run: of a shot of a thousand million frames few need be there.
    std::string lacking;
    int next = info.firstFrame;
    const auto lackUpTo = [&](int last) {
        if (next <= last) lacking += (lacking.empty() ? "" : ",") + rangeOf(next, last);
    };
    for (const int frame : frames) {
        if (frame < next || frame > info.lastFrame) continue;
        lackUpTo(frame - 1);
        next = frame + 1;
    }
    lackUpTo(info.lastFrame);
    return lacking;
}

int finishTakeFrames(const TakeFrames& chosen, const std::string& output, Console& console)
{
    if (chosen.missing.empty()) return kExitDone;
    console.error("\"" + output + "\" lacks frames " + chosen.missing + " of the shot");
    return exitCodeFor(ErrorKind::missingInput);
}

}  // namespace scree
