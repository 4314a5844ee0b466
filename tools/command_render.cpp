// Take → preview pictures.
#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <map>
#include <mutex>

#include "core/base/parallel.h"
#include "core/diagnostics/phase_timer.h"
#include "io/frame_pattern.h"
#include "io/text_forms.h"
#include "render/legend.h"
#include "tools/command_line.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/picture_file.h"
#include "tools/progress.h"
#include "tools/stop_signals.h"
#include "tools/take_export.h"
#include "tools/take_frames.h"
#include "tools/take_painter.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
    std::string take, frames, output, camera, size, progress = "auto", engine = "osmesa",
                                                    look = "shaded", chunk;
    std::optional<int> threads, samples, motionBlur;
    bool skipExisting = false, burnIn = false, noBurnIn = false, slate = false;
};

/// Shot, frame, time, bodies, worst overlap: what a supervisor asks of a picture.
std::string burnInText(const TakeReader& take, int frame, std::size_t bodyCount,
                       const std::map<int, FrameSummary>& stats)
{
    const TakeInfo& info = take.info();
    char time[64];
    std::snprintf(time, sizeof time, "%.2f s", (frame - info.firstFrame) / info.framesPerSecond);
    std::string text = info.name + "  " + std::to_string(frame) + "  " + time + "  " +
                       std::to_string(bodyCount) + (bodyCount == 1 ? " body" : " bodies");
    if (const auto found = stats.find(frame); found != stats.end()) {
        char overlap[64];
        std::snprintf(overlap, sizeof overlap, "  overlap %.2f%%",
                      100.0 * found->second.overlapRatio);
        text += overlap;
    }
    return text;
}

/// What a PNG says of where it comes from.
PngText originText(const TakeReader& take, int frame, const std::map<int, FrameSummary>& stats)
{
    PngText text = {{"Software", "scree"},
                    {"Source", take.info().name + " frame " + std::to_string(frame)},
                    {"Shot", take.info().name},
                    {"Frame", std::to_string(frame)}};
    if (const auto found = stats.find(frame); found != stats.end())
        text.emplace_back("State hash", found->second.stateHash);
    return text;
}

std::vector<std::string> slateLines(const TakeReader& take, const std::vector<int>& frames,
                                    const std::array<int, 2>& size)
{
    const TakeInfo& info = take.info();
    char rate[64];
    std::snprintf(rate, sizeof rate, "%g frames per second", info.framesPerSecond);
    return {info.name,
            "frames " + describeFrames(frames),
            rate,
            std::to_string(size[0]) + " x " + std::to_string(size[1]),
            std::to_string(info.bodies.size()) + " bodies",
            "scree " + info.programVersion,
            "shot " + toHex(info.shotHash)};
}

/// The share of the frames that "2/8" asks for: the second of eight runs of neighbours.
std::vector<int> chunkOf(const std::vector<int>& frames, const std::string& text)
{
    if (text.empty()) return frames;
    int index = 0, count = 0, length = 0;
    if (std::sscanf(text.c_str(), "%6d/%6d%n", &index, &count, &length) != 2 ||
        length != static_cast<int>(text.size()) || count < 1 || index < 1 || index > count)
        throw Error(ErrorKind::usage,
                    "--chunk " + text + ": it must be I/N with 1 <= I <= N, like 2/8");
    const std::size_t begin = frames.size() * (index - 1) / count;
    const std::size_t end = frames.size() * index / count;
    return {frames.begin() + static_cast<std::ptrdiff_t>(begin),
            frames.begin() + static_cast<std::ptrdiff_t>(end)};
}

/// How a picture is drawn, as it says itself.
constexpr const char* kDrawnAs = "Drawn as";

/// A picture older than its frame shows something that is gone, and one that was drawn otherwise
/// something else: those of one camera stayed where another's were asked for.
bool isUpToDate(const fs::path& picture, const fs::path& frame, const std::string& drawnAs)
{
    std::error_code code;
    if (!fs::exists(picture, code) ||
        fs::last_write_time(picture, code) < fs::last_write_time(frame, code) || code)
        return false;
    try {
        const PngText text = readPng(picture).text;
        return std::ranges::find(text, std::pair<std::string, std::string>(kDrawnAs, drawnAs)) !=
               text.end();
    } catch (const Error&) {
        return false;  // no whole picture
    }
}

PaintSettings paintSettings(const RenderOptions& options, const TakeInfo& info)
{
    PaintSettings settings;
    settings.isRayTraced = options.engine == "embree";
    settings.samples = options.samples.value_or(0);
    settings.look = parseLook(options.look);
    settings.motionBlur = options.motionBlur.value_or(info.motionBlur);
    if (!settings.isRayTraced && options.samples && *options.samples != 1 && *options.samples != 4)
        throw Error(ErrorKind::usage, "--samples: osmesa takes 1 or 4, embree any number");
    return settings;
}

/// Paints frames, several at once, and writes each as soon as it is there.
class RenderRun {
public:
    RenderRun(const RenderOptions& options, Console& console)
        : options_(options),
          console_(console),
          progressMode_(parseProgressMode(options.progress)),
          take_((setThreadCount(threadsToUse(options.threads)), options.take))
    {
        chosen_ = chooseTakeFrames(options.frames, take_, console);
        const std::vector<int>& asked = chosen_.frames;
        if (asked.empty())
            throw Error(ErrorKind::missingInput, "\"" + options.take + "\" has no frames");
        frames_ = chunkOf(asked, options.chunk);
        pattern_ =
            options.output.empty()
                ? (take_.paths().root / "images" / (take_.info().name + ".####.png")).string()
                : options.output;
        requirePngName(pattern_);
        if (asked.size() > 1 || options.slate || hasFramePattern(pattern_))
            expandFramePattern(pattern_, asked[0]);
        createFolderOf(pattern_, console);
        size_ = options.size.empty() ? take_.info().pictureSize : parseSize(options.size);
        for (const FrameSummary& frame : take_.stats()) stats_[frame.frame] = frame;
        hasBurnIn_ = options.burnIn || (take_.info().burnIn && !options.noBurnIn);
        // The slate belongs to the whole: of a farm's chunks only the first one writes it.
        const int slate = asked[0] - (asked.size() > 1 ? asked[1] - asked[0] : 1);
        if (options.slate && options.output.empty() && stats_.contains(slate))
            throw Error(ErrorKind::usage,
                        "--slate: the slate would be the picture of frame " +
                            std::to_string(slate) +
                            ", which the take has: give these pictures another name with -o");
        if (options.slate && !frames_.empty() && frames_[0] == asked[0])
            writePng(expandFramePattern(pattern_, slate),
                     makeSlate(size_[0], size_[1], slateLines(take_, asked, size_)),
                     {{"Software", "scree"}});
    }

    int run()
    {
        paintAll();
        heedStop("the pictures written so far are whole, --skip-existing keeps them");
        std::printf("%s\n", pattern_.c_str());
        return finishTakeFrames(chosen_, pattern_, console_);
    }

private:
    void paintAll() const
    {
        // Without a camera of its own the view follows from all frames, not from those asked for: a
        // frame rendered alone looks as it does in the sequence.
        TakePainter painter(take_, options_.camera, size_, paintSettings(options_, take_.info()));
        Progress progress(console_, progressMode_, "render", static_cast<int>(frames_.size()));
        std::atomic<std::size_t> next = 0;
        std::mutex progressLock;
        // Encoding of one picture goes on beside the drawing of the next.
        parallelFor(painter.usefulThreads(), 1, [&](std::size_t, std::size_t) {
            for (std::size_t i = next++; i < frames_.size() && !stopRequested(); i = next++) {
                const Stopwatch watch;
                paint(painter, frames_[i]);
                const double taken = watch.seconds();
                const std::lock_guard lock(progressLock);
                progress.frameDone(frames_[i], taken / painter.usefulThreads());
            }
        });
    }

    void paint(TakePainter& painter, int frame) const
    {
        const fs::path picture =
            hasFramePattern(pattern_) ? expandFramePattern(pattern_, frame) : pattern_;
        const std::string drawnNow = drawnAs(painter.viewAt(frame));
        if (options_.skipExisting && isUpToDate(picture, take_.paths().frame(frame), drawnNow))
            return;
        const std::string text = hasBurnIn_
                                     ? burnInText(take_, frame, painter.bodyCountAt(frame), stats_)
                                     : std::string();
        PngText origin = originText(take_, frame, stats_);
        origin.emplace_back(kDrawnAs, drawnNow);
        writePng(picture, painter.paint(frame, text), origin);
    }

    std::string drawnAs(const std::string& view) const
    {
        return "camera \"" + options_.camera + "\" " + view + ", look " + options_.look + ", " +
               options_.engine + ", " + std::to_string(options_.samples.value_or(0)) +
               " samples, blur " +
               std::to_string(options_.motionBlur.value_or(take_.info().motionBlur)) + ", " +
               std::to_string(size_[0]) + "x" + std::to_string(size_[1]) +
               (hasBurnIn_ ? ", burned in" : "");
    }

    const RenderOptions& options_;
    Console& console_;
    ProgressMode progressMode_;
    TakeReader take_;
    TakeFrames chosen_;
    std::vector<int> frames_;  // of those the ones in this chunk
    std::string pattern_;
    std::array<int, 2> size_ = {};
    std::map<int, FrameSummary> stats_;
    bool hasBurnIn_ = true;
};

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
                      "Leave pictures that are newer than their frame and were drawn as these are");
    command->add_option("--chunk", options->chunk,
                        "I/N: the I-th of N runs of frames, for N machines of a farm");
    command->add_option("--engine", options->engine, "osmesa, or embree: ray-traced [osmesa]")
        ->check(oneOf({"osmesa", "embree"}));
    command
        ->add_option("--samples", options->samples,
                     "A pixel: 1 or 4 with osmesa [1], any number with embree [8]")
        ->check(CLI::Range(1, 65536));
    command
        ->add_option("--motion-blur", options->motionBlur,
                     "Mean of so many moments while the shutter is open [1: none]")
        ->check(CLI::Range(1, 1000));
    command->add_option("--look", options->look,
                        "What colours tell: " + knownLooks() + " [shaded]");
    CLI::Option* burnIn = command->add_flag("--burnin", options->burnIn,
                                            "Shot, frame, time, bodies and overlap in the picture");
    command->add_flag("--no-burnin", options->noBurnIn, "Nothing written into the pictures")
        ->excludes(burnIn);
    command->add_flag("--slate", options->slate,
                      "A card that says what follows, one picture before the first");
    addProgress(*command, options->progress);
    command->footer(std::string(kMissingFramesHelp) +
                    "Example:\n  scree render takes/rings_100 --frames 1001-1240x2 --size 640x360");
    return {command, [options](Console& console) { return RenderRun(*options, console).run(); }};
}

}  // namespace scree
