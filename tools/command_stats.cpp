// Take → a page of plots.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "core/base/parallel.h"
#include "io/file_bytes.h"
#include "render/png_writer.h"
#include "tools/command_line.h"
#include "tools/commands.h"
#include "tools/parts_progress.h"
#include "tools/stats_page.h"
#include "tools/stop_signals.h"
#include "tools/take_export.h"
#include "tools/take_frames.h"
#include "tools/take_painter.h"

namespace scree {
namespace {

constexpr int kThumbnailWidth = 480;

struct StatsOptions {
    std::string take, output, progress = "auto";
    int pictures = 32;
};

std::vector<Thumbnail> paintThumbnails(const TakeReader& take, int count, Console& console,
                                       ProgressMode mode)
{
    const std::vector<int> frames = spreadFrames(take.frames(), count);
    const std::array<int, 2> shotSize = take.info().pictureSize;
    const int height = std::max(1, kThumbnailWidth * shotSize[1] / shotSize[0]);
    PartsProgress progress(console, mode, static_cast<int>(frames.size()));
    TakePainter painter(take, "", {kThumbnailWidth, height});
    std::vector<Thumbnail> thumbnails(frames.size());
    parallelFor(frames.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && !stopRequested(); ++i) {
            thumbnails[i] = {frames[i], encodePng(painter.paint(frames[i]))};
            progress.partDone();
        }
    });
    return thumbnails;
}

int runStats(const StatsOptions& options, Console& console)
{
    const ProgressMode progress = parseProgressMode(options.progress);
    requirePageName(options.output);
    setThreadCount(threadsToUse(std::nullopt));
    const TakeReader take(options.take);
    if (take.frames().empty())
        throw Error(ErrorKind::missingInput, "\"" + options.take + "\" has no frames");
    const std::filesystem::path output =
        options.output.empty() ? take.paths().statsPage() : std::filesystem::path(options.output);
    createFolderOf(output, console);
    const std::vector<Thumbnail> thumbnails =
        options.pictures > 0 ? paintThumbnails(take, options.pictures, console, progress)
                             : std::vector<Thumbnail>();
    heedStop("no page was written");
    writeFileBytes(output, makeStatsPage(take, thumbnails));
    std::printf("%s\n", output.c_str());
    const TakeFrames shown{take.frames(), framesLacking(take.info(), take.frames())};
    return finishTakeFrames(shown, output.string(), console);
}

}  // namespace

Command addStatsCommand(CLI::App& program)
{
    auto options = std::make_shared<StatsOptions>();
    CLI::App* command =
        program.add_subcommand("stats", "Plot how a take went, on one page for a browser");
    command->add_option("TAKE", options->take, "The take directory")->required();
    command->add_option("-o,--output", options->output, "The HTML file [TAKE/stats.html]");
    command
        ->add_option("--pictures", options->pictures, "Frames that are drawn, evenly spread [32]")
        ->check(CLI::Range(0, 1000));
    addProgress(*command, options->progress);
    command->footer(
        "When frames of the shot are missing the page shows those that are there, and the exit "
        "code is 66.\nExample:\n  scree stats takes/rings_100 -o rings.html");
    return {command, [options](Console& console) { return runStats(*options, console); }};
}

}  // namespace scree
