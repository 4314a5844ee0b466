// A take, or pictures that are there already, at a glance.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <optional>

#include "core/base/parallel.h"
#include "render/contact_sheet.h"
#include "tools/command_line.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/parts_progress.h"
#include "tools/picture_file.h"
#include "tools/stop_signals.h"
#include "tools/take_export.h"
#include "tools/take_frames.h"
#include "tools/take_painter.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr int kUsualCount = 12;

struct SheetOptions {
    std::vector<std::string> inputs;
    std::string output, frames, camera, progress = "auto";
    std::optional<int> count;
    SheetLayout layout;
};

/// Draws the frames anew, in the size of the cells: quicker than reading large pictures.
std::vector<LabelledImage> paintTake(const SheetOptions& options, const TakeReader& take,
                                     const std::vector<int>& chosen, Console& console)
{
    // Who names frames wants to see them all, if he does not say how many.
    const bool isSpread = options.frames.empty() || options.count;
    const std::vector<int> frames =
        isSpread ? spreadFrames(chosen, options.count.value_or(kUsualCount)) : chosen;
    const std::array<int, 2> shotSize = take.info().pictureSize;
    const int width = options.layout.cellWidth;
    const int height = std::max(1, width * shotSize[1] / shotSize[0]);
    PartsProgress progress(console, parseProgressMode(options.progress),
                           static_cast<int>(frames.size()));
    TakePainter painter(take, options.camera, {width, height});
    std::vector<LabelledImage> pictures;
    for (const int frame : frames) {
        if (stopRequested()) break;
        pictures.push_back({painter.paint(frame), std::to_string(frame)});
        progress.partDone();
    }
    return pictures;
}

std::vector<LabelledImage> readPictures(const SheetOptions& options, Console& console)
{
    PartsProgress progress(console, parseProgressMode(options.progress),
                           static_cast<int>(options.inputs.size()));
    std::vector<LabelledImage> pictures;
    for (const std::string& path : options.inputs) {
        if (stopRequested()) break;
        std::error_code ignored;
        if (fs::is_directory(path, ignored))
            throw Error(ErrorKind::usage, "\"" + path +
                                              "\" is a folder: a sheet is made of one take, or of "
                                              "PNG files");
        const Image image = readPng(path).image;
        const int width = std::min(image.width, options.layout.cellWidth);
        const int height = std::max(1, image.height * width / image.width);
        pictures.push_back({downscaled(image, width, height), fs::path(path).stem().string()});
        progress.partDone();
    }
    return pictures;
}

void writeSheet(const SheetOptions& options, const std::vector<LabelledImage>& pictures,
                Console& console)
{
    heedStop("no sheet was written");
    createFolderOf(options.output, console);
    writePng(options.output, makeContactSheet(pictures, options.layout), {{"Software", "scree"}});
    std::printf("%s\n", options.output.c_str());
}

int runSheet(const SheetOptions& options, Console& console)
{
    setThreadCount(threadsToUse(std::nullopt));
    parseProgressMode(options.progress);  // what is no such word is told first
    requirePngName(options.output);
    std::error_code ignored;
    const bool isTake = options.inputs.size() == 1 && fs::is_directory(options.inputs[0], ignored);
    const bool areThere = std::ranges::all_of(
        options.inputs, [&](const std::string& path) { return fs::exists(path, ignored); });
    if (!isTake && areThere && !(options.frames.empty() && options.camera.empty()))
        throw Error(ErrorKind::usage, "--frames and --camera belong to a take, not to pictures");
    if (!isTake) {
        writeSheet(options, readPictures(options, console), console);
        return kExitDone;
    }
    const TakeReader take(options.inputs[0]);
    const TakeFrames chosen = chooseTakeFrames(options.frames, take, console);
    if (chosen.frames.empty())
        throw Error(ErrorKind::missingInput, "\"" + options.inputs[0] + "\" has no frames to draw");
    writeSheet(options, paintTake(options, take, chosen.frames, console), console);
    return finishTakeFrames(chosen, options.output, console);
}

}  // namespace

Command addSheetCommand(CLI::App& program)
{
    auto options = std::make_shared<SheetOptions>();
    CLI::App* command =
        program.add_subcommand("sheet", "Put frames of a take, or pictures, on one sheet");
    command->add_option("INPUT", options->inputs, "A take directory, or PNG files")
        ->required()
        ->type_name("TAKE|PNG...");
    command->add_option("-o,--output", options->output, "The PNG file to write")->required();
    command->add_option("--frames", options->frames, "These frames of the take [all]");
    command
        ->add_option("--count", options->count,
                     "How many frames, evenly spread [12; with --frames all of them]")
        ->check(CLI::Range(1, 1000));
    command->add_option("--columns", options->layout.columns, "Pictures in a row [4]")
        ->check(CLI::Range(1, 100));
    command->add_option("--width", options->layout.cellWidth, "Of one picture, in pixels [400]")
        ->check(CLI::Range(16, 4096));
    command->add_option("--camera", options->camera, "Name of a camera of the shot [the first]");
    addProgress(*command, options->progress);
    command->footer(std::string(kMissingFramesHelp) +
                    "Example:\n  scree sheet takes/rings_100 -o rings.png");
    return {command, [options](Console& console) { return runSheet(*options, console); }};
}

}  // namespace scree
