// Shot → take. Frames are safe on disk one by one; everything that can end a run early (signals, a
// full disk, numbers that are none) leaves them there and says how to go on.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <new>

#include "core/base/parallel.h"
#include "core/diagnostics/phase_timer.h"
#include "core/dynamics/start_overlap.h"
#include "core/dynamics/step_figures.h"
#include "core/dynamics/stepper.h"
#include "io/build_world.h"
#include "io/frame_pattern.h"
#include "io/shot_parser.h"
#include "io/subframes.h"
#include "io/take.h"
#include "io/take_reader.h"
#include "io/text_forms.h"
#include "tools/broken_frame.h"
#include "tools/command_line.h"
#include "tools/commands.h"
#include "tools/cpu_time.h"
#include "tools/exit_code.h"
#include "tools/overlap_watch.h"
#include "tools/progress.h"
#include "tools/run_start.h"
#include "tools/shell_line.h"
#include "tools/simulation.h"
#include "tools/stop_signals.h"
#include "tools/stoppable_build.h"
#include "tools/take_export.h"
#include "tools/version.h"

namespace scree {
namespace {

/// The command that goes on with the take. It repeats all that decides what the take becomes: given
/// other settings, --resume would refuse.
std::string commandToGoOn(const SimOptions& options, const std::string& folder)
{
    std::vector<std::string> words = {"scree", "sim", options.shot, "-o", folder};
    const auto add = [&](const std::string& flag, const std::string& value) {
        words.insert(words.end(), {flag, value});
    };
    if (!options.frames.empty()) add("--frames", options.frames);
    if (!options.from.empty()) add("--from", options.from);
    for (const std::string& word :
         wordsOfRun(options.overrides, options.importLimits, options.threads, options.noCache))
        words.push_back(word);
    words.push_back("--resume");
    return shellLine(words);
}

/// One run of `scree sim`, from the first missing frame to the last.
class SimRun {
public:
    SimRun(const SimOptions& options, Console& console)
        : options_(options), console_(console), progressMode_(parseProgressMode(options.progress))
    {
        std::optional<TakeBranch> branch;
        if (!options.from.empty()) branch = parseBranch(options.from);
        setThreadCount(threadsToUse(options.threads));
        shot_ = parseShot(options.shot, options.overrides, options.importLimits);
        lastFrame_ = chooseLastFrame();
        const std::string folder = options.take.empty() ? "takes/" + shot_.name : options.take;
        world_ = worldAtStart(shot_, options.noCache, console);
        subframes_.emplace(shot_, world_);
        overlaps_.emplace(shot_, world_, console);
        const ExistingTake existing = options.overwrite ? ExistingTake::overwrite
                                      : options.resume  ? ExistingTake::resume
                                                        : ExistingTake::refuse;
        take_.emplace(folder, shot_, world_, programVersion(), existing, branch);
        for (const std::string& notice : take_->notices()) console.warning(notice);
        std::vector<ShotBody>().swap(shot_.bodies);  // the world has them; a kilobyte each
    }

    int run()
    {
        const std::string folder = take_->paths().root.string();
        const int simulated = simulateOrTell();
        if (isStopped_) {
            console_.info("stopped in frame " + std::to_string(stoppedIn_) +
                          "; the state is saved, go on with: " + commandToGoOn(options_, folder));
            return kExitStopped;
        }
        if (simulated == 0)
            console_.info("nothing to simulate: " + folder +
                          (lastFrame_ == shot_.lastFrame
                               ? " is complete"
                               : " has all frames up to " + std::to_string(lastFrame_)));
        if (!writeExports(simulated > 0)) {
            console_.info("stopped while exporting; the frames are saved, go on with: " +
                          commandToGoOn(options_, folder));
            return kExitStopped;
        }
        if (options_.printsTake) std::printf("%s\n", folder.c_str());
        return overlaps_->judge(take_->summaries(), lastFrame_) ? kExitDone : kExitQuality;
    }

private:
    int chooseLastFrame() const
    {
        if (options_.frames.empty()) return shot_.lastFrame;
        const std::vector<int> asked = parseFrames(options_.frames);
        const int last = asked.back();
        if (asked.front() < shot_.firstFrame || last > shot_.lastFrame)
            throw Error(ErrorKind::usage, "--frames " + options_.frames + ": the shot has " +
                                              std::to_string(shot_.firstFrame) + "-" +
                                              std::to_string(shot_.lastFrame));
        return last;
    }

    int simulateOrTell()
    {
        try {
            return simulate();
        } catch (const std::bad_alloc&) {
            const std::string folder = take_->paths().root.string();
            throw Error(ErrorKind::internal,
                        "memory ran out after frame " + std::to_string(take_->lastWholeFrame()) +
                            "; the frames are kept, with more memory go on with: " +
                            commandToGoOn(options_, folder));
        }
    }

    /// Simulates what is missing; returns how many frames that were.
    int simulate()
    {
        const int total = lastFrame_ - shot_.firstFrame + 1;
        int missing = 0;
        for (int frame = shot_.firstFrame; frame <= lastFrame_; ++frame)
            missing += !take_->hasFrame(frame);
        if (missing == 0) return 0;
        console_.info(shot_.name + ": " + std::to_string(world_.bodyCount()) +
                      (world_.bodyCount() == 1 ? " body" : " bodies") + ", frames " +
                      std::to_string(shot_.firstFrame) + "-" + std::to_string(lastFrame_) + ", " +
                      std::to_string(total - missing) + " there already, " +
                      std::to_string(threadCount()) +
                      (threadCount() == 1 ? " thread" : " threads"));

        Progress progress(console_, progressMode_, "sim", total, total - missing);
        Stepper stepper(shot_.settings);
        if (shot_.output.contacts) stepper.observe(&lastStep_);
        if (!take_->hasFrame(shot_.firstFrame)) {
            writeInitialFrame();
            progress.frameDone(shot_.firstFrame, 0.0, {}, 0.0);  // nothing to time yet
        } else {
            overlaps_->goOnLookingAt(readFrameFile(take_->paths().frame(shot_.firstFrame)).untold);
        }
        for (int frame = shot_.firstFrame + 1; frame <= lastFrame_ && !isStopped_; ++frame)
            if (!take_->hasFrame(frame)) simulateFrame(frame, stepper, progress);
        return missing;
    }

    /// Time zero, where nothing has moved yet.
    void writeInitialFrame()
    {
        FrameStats stats;
        stats.frame = shot_.firstFrame;
        stats.report = reportStart(world_, shot_.settings.gravity);
        overlaps_->lookAtPoses(shot_.firstFrame, stats.report);
        stats.report.sum.deepestBeforePushOut = stats.report.sum.deepestAfterPushOut;
        take_->writeFrame(world_, stats, {}, {}, overlaps_->untold());
    }

    void simulateFrame(int frame, Stepper& stepper, Progress& progress)
    {
        const FrameReport earlier = prepareFor(frame);
        FrameStats stats;
        stats.frame = frame;
        stats.resumedAtSubStep = world_.clock.subStep;
        const Stopwatch watch;
        const double cpuBefore = cpuSeconds();
        const double duration = 1.0 / shot_.framesPerSecond;
        const double shareToDo = 1.0 - world_.clock.frameTimeDone / duration;
        bool isToSave = false;
        const auto askStop = [&] {
            progress.insideFrame(frame, world_.clock.frameTimeDone / duration);
            isToSave = takeSaveRequest();
            return isToSave || stopRequested();
        };
        // A save stops the frame as a stop does: what was found on the way is told by nobody else.
        stats.report = earlier;
        do {
            FrameReport part = stepper.advanceFrame(
                world_, duration, askStop,
                [&](const World& world, double time) { subframes_->afterStep(world, time); });
            addEarlier(stats.report, part);
            stats.report = std::move(part);
            refuseBroken(frame, stats.report);
            if (!stats.report.finished) save(stats.report);
            if (isToSave && !stats.report.finished) tellSaved(frame);
        } while (!stats.report.finished && !stopRequested());
        stats.wallSeconds = watch.seconds();
        stats.cpuSeconds = cpuSeconds() - cpuBefore;
        if (!stats.report.finished) {
            isStopped_ = true;
            stoppedIn_ = frame;
            return;
        }
        overlaps_->lookAtPoses(frame, stats.report);
        take_->writeFrame(world_, stats, subframes_->samples(), lastStep(), overlaps_->untold());
        subframes_->begin(world_, {});
        overlaps_->warn(frame, stats.report);
        warnOfCap(frame, stats.report);
        if (frame == shot_.lastFrame) warnOfUnborn();
        progress.frameDone(frame, stats.wallSeconds,
                           {stats.report.bodiesAwake, stats.report.sum.contactPairs}, shareToDo);
        if (takeSaveRequest()) tellSaved(frame);  // the frame itself is what to go on from
        if (stopRequested() && frame < lastFrame_) {
            isStopped_ = true;
            stoppedIn_ = frame + 1;
        }
    }

    /// A frame's last step is never taken in an earlier sitting: checkpoints need not keep it.
    std::optional<StepSeen> lastStep() const
    {
        if (!shot_.output.contacts) return {};
        return lastStep_.seen;
    }

    /// Takes up what an earlier sitting has left of the way to `frame`; answers with its figures.
    FrameReport prepareFor(int frame)
    {
        const std::optional<FrameState> left = take_->prepareFor(frame, world_);
        subframes_->begin(world_, left ? left->between : std::vector<SceneFrame>());
        if (!left) return {};
        overlaps_->goOnLookingAt(left->untold);
        return left->soFar;
    }

    void save(const FrameReport& soFar)
    {
        take_->writeCheckpoint(world_, subframes_->samples(), soFar, overlaps_->untold());
    }

    void tellSaved(int frame)
    {
        console_.answer("scree: saved in frame " + std::to_string(frame) + " of " +
                        std::to_string(shot_.firstFrame) + "-" + std::to_string(lastFrame_) +
                        ", sub-step " + std::to_string(world_.clock.subStep));
    }

    void refuseBroken(int frame, const FrameReport& report)
    {
        const std::string complaint = complaintOf(report, world_, frame);
        if (complaint.empty()) return;
        throw Error(ErrorKind::qualityLimit, complaint + "; frames up to " +
                                                 std::to_string(frame - 1) + " are kept in \"" +
                                                 take_->paths().root.string() + "\"");
    }

    /// An emitter's count is a promise: who could not come is told.
    void warnOfUnborn()
    {
        std::size_t waiting = 0, skipped = 0;
        for (const PlannedBirth& birth : world_.births) {
            waiting += world_.bornAt[birth.body] == kUnborn;
            skipped += world_.bornAt[birth.body] == kSkipped;
        }
        if (waiting + skipped == 0) return;
        console_.warning(std::to_string(waiting + skipped) + " of " +
                         std::to_string(world_.births.size()) +
                         " emitted bodies never came, because their places were taken (" +
                         std::to_string(waiting) + " still waited at the last frame)");
    }

    void warnOfCap(int frame, const FrameReport& report)
    {
        if (!report.substepCapReached) return;
        const std::string text = "frame " + std::to_string(frame) +
                                 ": solver.substeps.max is reached; fast thin bodies may tunnel";
        warnOnce(console_, toldCap_, text);
    }

    /// Caches the shot asks for, made once the take is complete. False when stopped on the way.
    bool writeExports(bool hasNewFrames)
    {
        if (lastFrame_ != shot_.lastFrame) return true;
        const TakeReader reader(take_->paths().root);
        for (const std::string& ending : shot_.output.exports) {
            const std::filesystem::path output = defaultExport(reader, ending);
            if (!hasNewFrames && isUpToDate(output)) continue;
            // Without progress of its own: the simulation's has reached the end and must not go
            // back.
            if (!exportTake(reader, reader.frames(), output, console_, ProgressMode::none))
                return false;
            console_.info("wrote " + output.string());
        }
        return true;
    }

    /// Whether an export is no older than any frame: one that failed has left that of before.
    bool isUpToDate(const std::filesystem::path& output) const
    {
        // Of a sequence the last file is written last.
        const std::string last = framePath(output.string(), shot_.lastFrame);
        std::error_code code;
        const auto written = std::filesystem::last_write_time(last, code);
        if (code) return false;
        for (int frame = shot_.firstFrame; frame <= shot_.lastFrame; ++frame)
            if (std::filesystem::last_write_time(take_->paths().frame(frame), code) > written ||
                code)
                return false;
        return true;
    }

    const SimOptions& options_;
    Console& console_;
    ProgressMode progressMode_;
    Shot shot_;
    World world_;
    std::optional<TakeWriter> take_;
    std::optional<SubframeRecorder> subframes_;
    LastStep lastStep_;
    std::optional<OverlapWatch> overlaps_;
    int lastFrame_ = 0;
    bool isStopped_ = false;
    int stoppedIn_ = 0;
    bool toldCap_ = false;
};

}  // namespace

int simulate(const SimOptions& options, Console& console)
{
    try {
        return SimRun(options, console).run();
    } catch (const Stopped&) {
        console.info(kStoppedBeforeFrames);
        return kExitStopped;
    }
}

Command addSimCommand(CLI::App& program)
{
    auto options = std::make_shared<SimOptions>();
    CLI::App* command = program.add_subcommand("sim", "Simulate a shot into a take directory");
    command->add_option("SHOT", options->shot, "The shot file, or a folder with a shot.toml")
        ->required();
    command->add_option("-o,--output", options->take, "The take directory [takes/NAME]");
    command->add_option("--frames", options->frames,
                        "Simulate up to the last of these: 1001-1100 (a later --resume goes on)");
    addImportLimits(*command, options->importLimits);
    command->add_option("--threads", options->threads,
                        "Number of threads [all]; the result does not depend on it");
    CLI::Option* resume =
        command->add_flag("--resume", options->resume,
                          "Go on with the take, to the same bits; begin when there is none");
    command
        ->add_flag("--overwrite", options->overwrite,
                   "Replace the take that is there, with its images/, exports/ and stats.html")
        ->excludes(resume);
    command->add_option("--from", options->from,
                        "TAKE@FRAME: begin with that take's frames up to this one; the shot may "
                        "differ from the take's in length, settings and looks, not in bodies: of "
                        "its last frame, the same take with another camera. With --resume: begin "
                        "so when there is nothing to resume");
    addNoCache(*command, options->noCache);
    addOverrides(*command, options->overrides);
    addProgress(*command, options->progress);
    command->footer(
        "Stops cleanly on SIGINT and SIGTERM (exit code 75); SIGUSR1 saves and goes on.\n"
        "Example:\n  scree sim shots/rings_100.toml --set material.steel.friction=0.3 -o takes/b");
    return {command, [options](Console& console) { return simulate(*options, console); }};
}

}  // namespace scree
