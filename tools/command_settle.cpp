// Shot → one pose: drop props, run until all is at rest, keep where they lie.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/parallel.h"
#include "core/diagnostics/phase_timer.h"
#include "core/dynamics/stepper.h"
#include "core/math/rotation.h"
#include "core/scene/motion_script.h"
#include "io/atomic_file.h"
#include "io/build_world.h"
#include "io/file_bytes.h"
#include "io/frame_writer.h"
#include "io/pose_json.h"
#include "io/shot_parser.h"
#include "io/take_folder.h"
#include "io/text_forms.h"
#include "io/world_state.h"
#include "tools/broken_frame.h"
#include "tools/command_line.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/progress.h"
#include "tools/rolling_advice.h"
#include "tools/run_start.h"
#include "tools/settle_checkpoint.h"
#include "tools/settled_poses.h"
#include "tools/shell_line.h"
#include "tools/stop_signals.h"
#include "tools/take_export.h"

namespace scree {
namespace {

struct SettleOptions {
    std::string shot, output, progress = "auto";
    double seconds = 30.0;
    // The literal method keeps two blocks on each other creeping by 0.0016 for ever.
    double tolerance = 5e-3;
    std::optional<int> threads;
    bool noCache = false, resume = false;
    std::vector<std::string> overrides;
    ImportLimits importLimits;
};

constexpr double kWindowSeconds = 0.5;  // over which nothing may move

/// So much is lost at most when the program is killed or the machine goes down [s].
constexpr double kBetweenSaves = 300.0;

/// The command that goes on. It repeats all that decides what the pose becomes.
std::string commandToGoOn(const SettleOptions& options)
{
    std::vector<std::string> words = {"scree", "settle", options.shot, "-o", options.output};
    const SettleOptions usual;
    if (options.seconds != usual.seconds)
        words.insert(words.end(), {"--seconds", formatted("%.15g", options.seconds)});
    if (options.tolerance != usual.tolerance)
        words.insert(words.end(), {"--tolerance", formatted("%.15g", options.tolerance)});
    for (const std::string& word :
         wordsOfRun(options.overrides, options.importLimits, options.threads, options.noCache))
        words.push_back(word);
    words.push_back("--resume");
    return shellLine(words);
}

/// How far any point of the body can be from where it was, in bounding radii.
double movedRadii(const Shape& shape, const BodyMotion& before, const BodyMotion& now)
{
    return (now.position - before.position).norm() / shape.boundingRadius +
           chordOfTurn(before.orientation, now.orientation);
}

/// What keeps a pose from being the last.
struct Unrest {
    int moving = 0;                ///< bodies that have moved too far
    BodyId fastest = -1;           ///< of these
    double moved = 0.0;            ///< how far that one did, in its bounding radii
    std::optional<BodyId> unborn;  ///< one that is still to come
    bool isTooEarly = false;       ///< since the last birth, or what the shot itself sets in motion

    bool isNone() const { return moving == 0 && !unborn && !isTooEarly; }
};

/// The last moment at which the shot itself sets something in motion [s]: a key, a release, a force
/// that changes. What lies still until then is not at rest.
double endOfEvents(const World& world)
{
    double last = 0.0;
    const auto include = [&](double time) { last = std::max(last, time); };
    for (const BodyInfo& body : world.info) {
        if (!body.script) continue;
        const double release = static_cast<double>(body.keyedUntil) * world.frameDuration;
        const bool isReleased = body.keyedUntil != BodyInfo().keyedUntil;
        include(static_cast<double>(body.keyedFrom) * world.frameDuration);
        include(isReleased ? release : body.script->lastKeyTime());
    }
    for (const ForceField& field : world.fields) {
        if (!field.keys.empty()) include(field.keys.back().time);
    }
    return last;
}

/// Asked before anything is simulated: a slip in a name must not cost the run.
void requirePoseFormat(const std::string& output)
{
    const std::string name = inSmallLetters(output);
    if (name.ends_with(".poses") || name.ends_with(".json") || isExportable(name)) return;
    throw Error(ErrorKind::usage, "cannot write a pose to '" + output +
                                      "': expected a name ending in .poses, .json, .usda, "
                                      ".abc, .glb, .obj, .ply or .pov");
}

/// Runs a shot until nothing has moved for a while.
class Settling {
public:
    Settling(const SettleOptions& options, Console& console)
        : options_(options),
          console_(console),
          progressMode_(parseProgressMode(options.progress)),
          shot_(parseShot(options.shot, options.overrides, options.importLimits)),
          checkpoint_(checkpointBeside(options.output))
    {
        if (writesPoses()) requirePosableBodies(shot_, options.output);
        createFolderOf(options.output, console);
        AtomicFile{options.output};  // says now that nothing can be created there
        refuseForeignCheckpoint(checkpoint_);
        setThreadCount(threadsToUse(options.threads));
        world_ = worldAtStart(shot_, options.noCache, console);
        endOfEvents_ = endOfEvents(world_);
        startHash_ = hashText(encodeFrame(captureState(shot_, world_)));
        past_ = {world_.motion};
        takeUpCheckpoint();
    }

    int run()
    {
        if (!simulate()) {
            console_.info("stopped in frame " + std::to_string(world_.clock.frame + 1) +
                          ", nothing is at rest yet; the state is saved, go on with: " +
                          commandToGoOn(options_));
            return kExitStopped;
        }
        for (const std::string& file : write()) std::printf("%s\n", file.c_str());
        std::error_code ignored;
        std::filesystem::remove(checkpoint_, ignored);
        if (unrest_.isNone()) return kExitDone;
        console_.error("not at rest after " + describeDuration(options_.seconds) + ": " +
                       reasonOfUnrest() + "; the pose is written all the same");
        return kExitQuality;
    }

private:
    void takeUpCheckpoint()
    {
        if (!options_.resume) {
            if (isThere(checkpoint_))
                console_.info("\"" + checkpoint_.string() +
                              "\" is of a run that was stopped: --resume would go on with it");
            return;
        }
        std::optional<SettleCheckpoint> left = readCheckpoint(checkpoint_, startHash_);
        if (!left) return;
        restoreState(world_, left->state);
        past_ = std::move(left->past);
        console_.info("going on from frame " + std::to_string(world_.clock.frame) +
                      " after the start");
    }

    void save()
    {
        writeCheckpoint(checkpoint_, startHash_, {captureState(shot_, world_), past_});
        sinceSave_ = {};
    }

    /// A disk that is full now may not be at the end: it must not cost the run.
    void saveUnasked()
    {
        try {
            save();
        } catch (const Error& problem) {
            sinceSave_ = {};
            console_.warning(std::string(problem.what()) + "; the run goes on without");
        }
    }

    /// False when it was stopped before all was at rest.
    bool simulate()
    {
        Stepper stepper(shot_.settings);
        const auto window = static_cast<std::size_t>(
            std::max(1.0, std::ceil(kWindowSeconds * shot_.framesPerSecond)));
        const int most = static_cast<int>(std::ceil(options_.seconds * shot_.framesPerSecond));
        const int done = static_cast<int>(world_.clock.frame);
        Progress progress(console_, progressMode_, "settle", most, std::min(done, most));
        unrest_.isTooEarly = true;
        for (int frame = done + 1; frame <= most; ++frame) {
            const Stopwatch watch;
            FrameReport report;
            if (!advance(stepper, progress, frame, report)) return false;
            past_.push_back(world_.motion);
            if (past_.size() > window + 1) past_.pop_front();
            unrest_ = unrestSince(past_.front(), report.births);
            unrest_.isTooEarly = unrest_.isTooEarly || past_.size() <= window;
            if (unrest_.isNone()) {
                console_.info("at rest after " + std::to_string(frame) + " frames");
                return true;
            }
            progress.frameDone(frame, watch.seconds(),
                               {report.bodiesAwake, report.sum.contactPairs});
            // A frame of one step has no place between steps to be asked at.
            const bool isAsked = takeSaveRequest(), isStopped = stopRequested() && frame < most;
            if (isAsked || isStopped) save();
            if (isAsked) tellSaved();
            if (sinceSave_.seconds() > kBetweenSaves) saveUnasked();
            if (isStopped) return false;
        }
        return true;
    }

    /// Ends the frame; false when it was stopped within it.
    bool advance(Stepper& stepper, Progress& progress, int frame, FrameReport& report)
    {
        const double duration = 1.0 / shot_.framesPerSecond;
        bool isToSave = false;
        const auto askStop = [&] {
            progress.insideFrame(frame, world_.clock.frameTimeDone / duration);
            isToSave = takeSaveRequest();
            return isToSave || stopRequested();
        };
        do {
            report = stepper.advanceFrame(world_, duration, askStop);
            refuseBroken(report, shot_.firstFrame + frame);
            if (!report.finished) save();
            if (isToSave && !report.finished) tellSaved();
        } while (!report.finished && !stopRequested());
        return report.finished;
    }

    void tellSaved()
    {
        console_.answer("scree: saved in frame " + std::to_string(world_.clock.frame + 1) +
                        " after the start, sub-step " + std::to_string(world_.clock.subStep));
    }

    Unrest unrestSince(const std::vector<BodyMotion>& before, const BirthReport& births) const
    {
        Unrest unrest;
        unrest.isTooEarly = births.born > 0 || world_.time() < endOfEvents_ + kWindowSeconds;
        for (BodyId body = 0; body < static_cast<BodyId>(world_.bodyCount()); ++body) {
            if (world_.bornAt[body] == kUnborn && !unrest.unborn) unrest.unborn = body;
            if (!world_.mass[body].isMovable()) continue;
            const double moved =
                movedRadii(world_.shapeOf(body), before[body], world_.motion[body]);
            unrest.moving += moved > options_.tolerance;
            if (moved <= std::max(unrest.moved, options_.tolerance)) continue;
            unrest.moved = moved;
            unrest.fastest = body;
        }
        return unrest;
    }

    std::string reasonOfUnrest() const
    {
        if (world_.time() < endOfEvents_) {
            return "keys, releases and changes of force go on until " +
                   describeDuration(endOfEvents_) + " after the start (--seconds)";
        }
        if (unrest_.moving == 0 && unrest_.unborn)
            return "'" + world_.info[*unrest_.unborn].name + "' has not been born yet (--seconds)";
        if (unrest_.moving == 0) return "it has not lain still for half a second yet (--seconds)";
        const std::string most = "'" + world_.info[unrest_.fastest].name + "' still moves, " +
                                 percent(unrest_.moved) + " of its radius in half a second";
        const std::string others =
            unrest_.moving > 1 ? ", the most of " + std::to_string(unrest_.moving) : "";
        if (!rollsOn(world_, unrest_.fastest)) return most + others;
        std::string advice;
        for (const std::string& sentence : rollingAdvice(shot_, world_)) advice += "; " + sentence;
        return most + others + advice;
    }

    void refuseBroken(const FrameReport& report, int frame) const
    {
        const std::string complaint = complaintOf(report, world_, frame);
        if (!complaint.empty()) throw Error(ErrorKind::qualityLimit, complaint);
    }

    /// Says which files it wrote.
    std::vector<std::string> write() const
    {
        const SceneFrame frame = captureFrame(shot_, world_);
        if (writesPoses()) return writePoses(frame);
        double reach = 1.0;
        for (const Pose& pose : frame.worldFromAsset) {
            reach = std::max(reach, 1.5 * pose.position.norm());
        }
        const SceneDescription scene = describeScene(shot_, world_, reach);
        if (inSmallLetters(options_.output).ends_with(".json")) {
            writeFileBytes(options_.output, encodePoses(scene, frame));
            return {options_.output};
        }
        const std::unique_ptr<FrameWriter> writer = makePoseWriter(options_.output);
        writer->begin(scene, frame.frame, 1);
        writer->write(frame);
        writer->finish();
        return {options_.output};
    }

    std::vector<std::string> writePoses(const SceneFrame& frame) const
    {
        std::vector<std::string> written;
        for (const PosesFile& file : settledPoses(shot_, world_, frame, options_.output)) {
            writeFileBytes(file.path, file.text);
            written.push_back(file.path);
        }
        return written;
    }

    bool writesPoses() const { return inSmallLetters(options_.output).ends_with(".poses"); }

    const SettleOptions& options_;
    Console& console_;
    ProgressMode progressMode_;
    Shot shot_;
    World world_;
    std::filesystem::path checkpoint_;
    std::uint64_t startHash_ = 0;               // of the state the run began in
    std::deque<std::vector<BodyMotion>> past_;  // at the ends of the last frames
    Stopwatch sinceSave_;
    double endOfEvents_ = 0.0;  // [s]
    Unrest unrest_;             // after the last frame
};

}  // namespace

Command addSettleCommand(CLI::App& program)
{
    auto options = std::make_shared<SettleOptions>();
    CLI::App* command = program.add_subcommand(
        "settle", "Run a shot until all is at rest and write where the bodies lie");
    command->add_option("SHOT", options->shot, "The shot file")->required();
    command
        ->add_option("-o,--output", options->output,
                     "The ending chooses the format: out.poses, out.json, out.usda, out.abc, "
                     "out.glb, out.obj, out.ply or out.pov")
        ->required();
    command->add_option("--seconds", options->seconds, "Simulated time to give up after [30]")
        ->check(complaintIfNotFinite)
        ->check(CLI::Range(1e-3, 1e6));
    command
        ->add_option("--tolerance", options->tolerance,
                     "At rest is what moves less than this part of its radius in half a second "
                     "[0.005]")
        ->check(complaintIfNotFinite)
        ->check(CLI::Range(1e-12, 1.0));
    addImportLimits(*command, options->importLimits);
    command->add_option("--threads", options->threads, "Number of threads [all]");
    addNoCache(*command, options->noCache);
    addOverrides(*command, options->overrides);
    addProgress(*command, options->progress);
    command->add_flag(
        "--resume", options->resume,
        "Go on with a run that was stopped, to the same bits; begin when there is none");
    command->footer(
        "Ends with 79 when something still moves at the end; the pose is written all the same.\n"
        "Stopped by SIGINT or SIGTERM it ends with 75; --resume goes on to the same pose, from the "
        "state\nit has kept in OUTPUT.checkpoint, which it also keeps every five minutes and at "
        "SIGUSR1.\n"
        "A .poses file is what [[body]] poses = \"rings.poses\" reads; there is one for each "
        "[[body]] and [[emitter]] that moves, out_NAME.poses where they are several.\n"
        "Example:\n  scree settle shots/rings_100.toml -o rings.poses");
    return {command, [options](Console& console) {
                requirePoseFormat(options->output);
                refuseTakeFile(options->output);
                return Settling(*options, console).run();
            }};
}

}  // namespace scree
