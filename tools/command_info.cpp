// What is in a take.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "io/take_reader.h"
#include "io/text_forms.h"
#include "tools/command_line.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/stop_signals.h"
#include "tools/take_frames.h"

namespace scree {
namespace {

struct InfoOptions {
    std::string take;
    bool json = false;
};

struct MovingBody {
    std::string name;
    double speed = 0.0;  ///< of its origin [m/s]
    double degreesPerSecond = 0.0;
    double fastest = 0.0;  ///< of any of its points, at most [m/s]
};

/// The take in a few numbers.
struct TakeSummary {
    std::vector<int> frames;
    bool isFinished = false;
    bool hasCheckpoint = false;
    std::vector<int> damaged;  ///< of the frames
    std::string damage;        ///< of the first of them
    std::size_t movable = 0;
    double wallSeconds = 0.0, cpuSeconds = 0.0;
    FrameSummary worst;  ///< the frame with the deepest overlap
    FrameSummary last;
    std::size_t untold = 0;           ///< frames that stats.jsonl says nothing of
    std::vector<MovingBody> fastest;  ///< in the last frame, a few of those that move at all

    std::vector<int> wholeFrames() const
    {
        std::vector<int> whole;
        std::ranges::set_difference(frames, damaged, std::back_inserter(whole));
        return whole;
    }
};

/// Of what may move by itself: who keeps a heap awake is what people ask.
std::vector<MovingBody> fastestAtTheEnd(const TakeReader& take)
{
    constexpr std::size_t kMost = 3;
    const TakeInfo& info = take.info();
    const SceneDescription scene = take.describe(TakeReader::PlaneSize::any);
    const SceneFrame last = take.readFrame(take.frames().back());
    std::vector<MovingBody> moving;
    for (std::size_t b = 0; b < info.bodies.size(); ++b) {
        const double speed = info.metresPerUnit * last.velocity[b].norm();
        const double spin = last.angularVelocity[b].norm();
        if (info.bodies[b].mass == 0.0 || (speed == 0.0 && spin == 0.0)) continue;
        const Points& points = scene.meshes[scene.bodies[b].mesh].points;
        const double reach = info.metresPerUnit * points.colwise().norm().maxCoeff();
        moving.push_back({info.bodies[b].name, speed, spin * 180.0 / kPi, speed + spin * reach});
    }
    std::ranges::stable_sort(moving, std::ranges::greater{}, &MovingBody::fastest);
    moving.resize(std::min(moving.size(), kMost));
    return moving;
}

TakeSummary summarize(const TakeReader& take)
{
    TakeSummary summary;
    summary.frames = take.frames();
    for (const auto& [frame, damage] : take.damagedFrames([] { heedStop("nothing was told"); })) {
        if (summary.damaged.empty()) summary.damage = damage;
        summary.damaged.push_back(frame);
    }
    summary.isFinished =
        summary.damaged.empty() && static_cast<int>(summary.frames.size()) ==
                                       take.info().lastFrame - take.info().firstFrame + 1;
    std::error_code ignored;
    summary.hasCheckpoint = std::filesystem::exists(take.paths().checkpoint(), ignored);
    for (const TakeBody& body : take.info().bodies) summary.movable += body.mass > 0.0;
    std::set<int> untold(summary.frames.begin(), summary.frames.end());
    for (const FrameSummary& frame : take.stats()) {
        untold.erase(frame.frame);
        summary.wallSeconds += frame.wallSeconds;
        summary.cpuSeconds += frame.cpuSeconds;
        if (frame.overlapRatio >= summary.worst.overlapRatio) summary.worst = frame;
        if (frame.frame >= summary.last.frame) summary.last = frame;
    }
    summary.untold = untold.size();
    const bool isLastRead =
        !summary.frames.empty() &&
        (summary.damaged.empty() || summary.damaged.back() != summary.frames.back());
    if (isLastRead) summary.fastest = fastestAtTheEnd(take);
    return summary;
}

/// What the frames cost and how they went.
void printFigures(const TakeSummary& summary)
{
    std::printf("time       %s wall, %s of processors\n",
                describeDuration(summary.wallSeconds).c_str(),
                describeDuration(summary.cpuSeconds).c_str());
    std::printf("overlap    worst %.3g %% of a body's length, frame %d%s\n",
                100.0 * summary.worst.overlapRatio, summary.worst.frame,
                summary.worst.worstA.empty()
                    ? ""
                    : (" (" + summary.worst.worstA + ", " + summary.worst.worstB + ")").c_str());
    std::printf("at the end kinetic energy %.4g J, %d awake, state %s\n",
                summary.last.kineticEnergy, summary.last.bodiesAwake,
                summary.last.stateHash.c_str());
}

void printText(const TakeReader& take, const TakeSummary& summary)
{
    const TakeInfo& info = take.info();
    std::printf("shot       %s, frames %d-%d at %g a second, seed %llu\n", info.name.c_str(),
                info.firstFrame, info.lastFrame, info.framesPerSecond,
                static_cast<unsigned long long>(info.seed));
    std::printf("bodies     %zu, %zu of them movable, %zu shapes; 1 unit = %g m, up %s\n",
                info.bodies.size(), summary.movable, info.shapes.size(), info.metresPerUnit,
                info.zUp ? "+z" : "+y");
    std::printf("take       %s: %s%s\n", summary.isFinished ? "finished" : "unfinished",
                summary.frames.empty() ? "no frames" : describeFrames(summary.frames).c_str(),
                summary.hasCheckpoint ? " and a checkpoint" : "");
    if (!summary.damaged.empty())
        std::printf("damaged    %s: %s; scree sim --resume simulates them again\n",
                    describeFrames(summary.damaged).c_str(), summary.damage.c_str());
    if (summary.untold > 0)
        std::printf("figures    missing for %zu of %zu frames: stats.jsonl does not tell of them\n",
                    summary.untold, summary.frames.size());
    if (summary.untold < summary.frames.size()) printFigures(summary);
    for (std::size_t i = 0; i < summary.fastest.size(); ++i)
        std::printf("%s%s at %.3g m/s, %.3g degrees/s%s", i == 0 ? "fastest    " : "; ",
                    summary.fastest[i].name.c_str(), summary.fastest[i].speed,
                    summary.fastest[i].degreesPerSecond,
                    i + 1 == summary.fastest.size() ? " in the last frame\n" : "");
    std::printf("made by    scree %s, shot hash %s\n", info.programVersion.c_str(),
                toHex(info.shotHash).c_str());
}

void printJson(const TakeReader& take, const TakeSummary& summary)
{
    const TakeInfo& info = take.info();
    nlohmann::ordered_json json = {
        {"name", info.name},
        {"program_version", info.programVersion},
        {"shot_hash", toHex(info.shotHash)},
        {"shot_frames", {info.firstFrame, info.lastFrame}},
        {"fps", info.framesPerSecond},
        {"metres_per_unit", info.metresPerUnit},
        {"up", info.zUp ? "+z" : "+y"},
        {"seed", info.seed},
        {"bodies", info.bodies.size()},
        {"movable_bodies", summary.movable},
        {"shapes", info.shapes.size()},
        {"frames", describeFrames(summary.frames)},
        {"frame_count", summary.frames.size()},
        {"finished", summary.isFinished},
        {"damaged_frames", describeFrames(summary.damaged)},
        {"checkpoint", summary.hasCheckpoint},
        {"frames_without_figures", summary.untold},
        {"wall_s", summary.wallSeconds},
        {"cpu_s", summary.cpuSeconds},
        {"worst_overlap_ratio", summary.worst.overlapRatio},
        {"worst_overlap_frame", summary.worst.frame},
        {"last_kinetic_energy_J", summary.last.kineticEnergy},
        {"last_state_hash", summary.last.stateHash},
    };
    json["last_fastest"] = nlohmann::ordered_json::array();
    for (const MovingBody& body : summary.fastest)
        json["last_fastest"].push_back({{"body", body.name},
                                        {"speed_m_per_s", body.speed},
                                        {"spin_degrees_per_s", body.degreesPerSecond}});
    // Zeros would be taken for figures.
    if (summary.untold == summary.frames.size())
        for (const char* key : {"wall_s", "cpu_s", "worst_overlap_ratio", "worst_overlap_frame",
                                "last_kinetic_energy_J", "last_state_hash"})
            json[key] = nullptr;
    std::printf("%s\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

}  // namespace

Command addInfoCommand(CLI::App& program)
{
    auto options = std::make_shared<InfoOptions>();
    CLI::App* command = program.add_subcommand("info", "Say what is in a take");
    command->add_option("TAKE", options->take, "The take directory")->required();
    command->add_flag("--json", options->json, "As one JSON object");
    command->footer(
        "When frames of the shot are missing or damaged the exit code is 66.\n"
        "Example:\n  scree info takes/rings_100 --json");
    return {command, [options](Console& console) {
                const TakeReader take(options->take);
                const TakeSummary summary = summarize(take);
                if (options->json)
                    printJson(take, summary);
                else
                    printText(take, summary);
                const TakeFrames whole{summary.wholeFrames(),
                                       framesLacking(take.info(), summary.wholeFrames())};
                return finishTakeFrames(whole, options->take, console);
            }};
}

}  // namespace scree
