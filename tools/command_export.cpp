#include <CLI/CLI.hpp>
#include <cstdio>

#include "io/frame_pattern.h"
#include "tools/command_line.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/stop_signals.h"
#include "tools/take_export.h"
#include "tools/take_frames.h"

namespace scree {
namespace {

struct ExportOptions {
    std::string take, output, frames, progress = "auto";
};

int runExport(const ExportOptions& options, Console& console)
{
    const ProgressMode progress = parseProgressMode(options.progress);
    const TakeReader take(options.take);
    const TakeFrames chosen = chooseTakeFrames(options.frames, take, console);
    if (!exportTake(take, chosen.frames, options.output, console, progress))
        throw Stopped{hasFramePattern(options.output)
                          ? "of \"" + options.output + "\" the first frames were written"
                          : "\"" + options.output + "\" was not written"};
    std::printf("%s\n", options.output.c_str());
    return finishTakeFrames(chosen, options.output, console);
}

}  // namespace

Command addExportCommand(CLI::App& program)
{
    auto options = std::make_shared<ExportOptions>();
    CLI::App* command = program.add_subcommand("export", "Write a cache for another program");
    command->add_option("TAKE", options->take, "The take directory")->required();
    command
        ->add_option(
            "-o,--output", options->output,
            "The ending chooses the format: out.abc, out.usda, out.instances.usda, out.glb, "
            "out.####.obj, out.####.ply or out.####.pov")
        ->required();
    command->add_option("--frames", options->frames, "Only these, without gaps: 1001-1240");
    addProgress(*command, options->progress);
    command->footer(std::string(kMissingFramesHelp) +
                    "Example:\n  scree export takes/rings_100 -o rings.abc");
    return {command, [options](Console& console) { return runExport(*options, console); }};
}

}  // namespace scree
