// Take → preview pictures.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <map>

#include "core/base/parallel.h"
#include "io/frame_pattern.h"
#include "render/png_writer.h"
#include "tools/command_line.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/progress.h"
#include "tools/take_export.h"
#include "tools/take_painter.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
    std::string take, frames, output, camera, size, progress = "auto";
    std::optional<int> threads;
    bool skipExisting = false, noBurnIn = false;
};

/// Shot, frame, bodies, worst overlap: what a supervisor asks of a picture.
std::string burnInText(const TakeReader& take, int frame, const std::map<int, FrameSummary>& stats)
{
    std::string text = take.info().name + "  " + std::to_string(frame) + "  " +
                       std::to_string(take.info().bodies.size()) + " bodies";
    if (const auto found = stats.find(frame); found != stats.end()) {
        char overlap[64];
        std::snprintf(overlap, sizeof overlap, "  overlap %.2f%%",
                      100.0 * found->second.overlapRatio);
        text += overlap;
    }
    return text;
}

/// A picture older than its frame shows something that is gone.
bool isUpToDate(const fs::path& picture, const fs::path& frame)
{
    std::error_code code;
    return fs::exists(picture, code) &&
           fs::last_write_time(picture, code) >= fs::last_write_time(frame, code) && !code;
}

int runRender(const RenderOptions& options, Console& console)
{
    const ProgressMode progressMode = parseProgressMode(options.progress);
    setThreadCount(threadsToUse(options.threads));
    const TakeReader take(options.take);
    const std::vector<int> frames = chooseFrames(options.frames, take.frames());
    if (frames.empty())
        throw Error(ErrorKind::missingInput, "\"" + options.take + "\" has no frames");
    const std::string pattern =
        options.output.empty()
            ? (take.paths().root / "images" / (take.info().name + ".####.png")).string()
            : options.output;
    if (frames.size() > 1 || hasFramePattern(pattern)) expandFramePattern(pattern, frames[0]);
    createFolderOf(pattern);
    const std::array<int, 2> size =
        options.size.empty() ? take.info().pictureSize : parseSize(options.size);
    std::map<int, FrameSummary> stats;
    for (const FrameSummary& frame : take.stats()) stats[frame.frame] = frame;

    // Without a camera of its own the view follows from all frames, not from those asked for: a
    // frame rendered alone looks as it does in the sequence.
    TakePainter painter(take, take.frames(), options.camera, size);
    Progress progress(console, progressMode, "render", static_cast<int>(frames.size()));
    for (const int frame : frames) {
        const auto started = std::chrono::steady_clock::now();
        const fs::path picture =
            hasFramePattern(pattern) ? expandFramePattern(pattern, frame) : pattern;
        if (!options.skipExisting || !isUpToDate(picture, take.paths().frame(frame))) {
            const std::string text =
                options.noBurnIn ? std::string() : burnInText(take, frame, stats);
            writePng(picture, painter.paint(frame, text),
                     {{"Software", "scree"},
                      {"Source", take.info().name + " frame " + std::to_string(frame)}});
        }
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - started;
        progress.frameDone(frame, taken.count());
    }
    std::printf("%s\n", pattern.c_str());
    return kExitDone;
}

}  // namespace

Command addRenderCommand(CLI::App& program)
{
    auto options = std::make_shared<RenderOptions>();
    CLI::App* command = program.add_subcommand("render", "Draw preview pictures of a take");
    command->add_option("TAKE", options->take, "The take directory")->required();
    command->add_option("--frames", options->frames, "Only these: 1001-1240x2, or a list");
    command->add_option("-o,--output", options->output,
                        "name.####.png [TAKE/images/SHOT.####.png]");
    command->add_option("--camera", options->camera, "Name of a camera of the shot [the first]");
    command->add_option("--size", options->size, "WIDTHxHEIGHT [of the shot]");
    command->add_option("--threads", options->threads, "Number of threads [all]");
    command->add_flag("--skip-existing", options->skipExisting,
                      "Leave pictures that are newer than their frame");
    command->add_flag("--no-burnin", options->noBurnIn, "Nothing written into the pictures");
    command->add_option("--progress", options->progress, "auto, tty, alf, json or none");
    command->footer("Example:\n  scree render takes/rings_100 --frames 1001-1240x2 --size 640x360");
    return {command, [options](Console& console) { return runRender(*options, console); }};
}

}  // namespace scree
