#include "io/frame_stats.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/dynamics/step_figures.h"
#include "io/text_forms.h"

namespace scree {
namespace {

using Json = nlohmann::ordered_json;

const char* nameOf(StepLimit limit)
{
    switch (limit) {
        case StepLimit::frame:
            return "frame";
        case StepLimit::relativeSpeed:
            return "relative_speed";
        case StepLimit::spin:
            return "spin";
        case StepLimit::hover:
            return "hover";
        case StepLimit::substepCap:
            return "substep_cap";
    }
    return "unknown";
}

std::string bodyName(const World& world, BodyId body)
{
    const bool known = body >= 0 && static_cast<std::size_t>(body) < world.info.size();
    return known ? world.info[body].name : "";
}

Json toJson(const ImpulseCounts& counts)
{
    return {{"sticking", counts.sticking},
            {"sliding", counts.sliding},
            {"fallback", counts.fallback},
            {"rolling", counts.rolling},
            {"rolling_dropped", counts.rollingDropped}};
}

Json phaseTimes(const StepReport& report)
{
    Json times = Json::object();
    for (int phase = 0; phase < static_cast<int>(Phase::count); ++phase)
        times[scree::nameOf(static_cast<Phase>(phase))] = 1e3 * report.seconds[phase];
    return times;
}

/// JSON has no word for what is not finite; such figures are written as null. They are too large
/// rather than too small for any limit they are compared with.
double numberFrom(const Json& json)
{
    return json.is_null() ? std::numeric_limits<double>::infinity() : json.get<double>();
}

FrameSummary summaryFromLine(const std::string& line)
{
    const Json json = Json::parse(line);
    FrameSummary summary;
    summary.frame = json.at("frame");
    summary.wallSeconds = json.at("wall_s");
    summary.cpuSeconds = json.at("cpu_s");
    summary.steps = json.at("substeps");
    summary.contactPairs = json.at("contact_pairs");
    summary.bodiesAwake = json.at("bodies_awake");
    summary.overlapRatio = numberFrom(json.at("overlap").at("worst_ratio"));
    summary.worstA = json.at("overlap").at("bodies").at(0);
    summary.worstB = json.at("overlap").at("bodies").at(1);
    summary.kineticEnergy = numberFrom(json.at("kinetic_energy_J"));
    summary.stateHash = json.at("state_hash");
    summary.line = line;
    return summary;
}

}  // namespace

void addEarlier(const FrameReport& earlier, FrameReport& later)
{
    if (earlier.steps == 0) return;
    if (earlier.shortestStep <= later.shortestStep) {
        later.shortestStep = earlier.shortestStep;
        later.sum.limitedBy = earlier.sum.limitedBy;
        later.fastestBody = earlier.fastestBody;
    }
    later.steps += earlier.steps;
    later.longestStep = std::max(earlier.longestStep, later.longestStep);
    later.substepCapReached = earlier.substepCapReached || later.substepCapReached;
    StepReport sum = earlier.sum;
    addFigures(later.sum, sum);
    sum.limitedBy = later.sum.limitedBy;
    sum.nonFinite = later.sum.nonFinite;
    sum.nonFinitePhase = later.sum.nonFinitePhase;
    later.sum = sum;
}

std::string encodeStats(const FrameStats& stats, const World& world)
{
    const FrameReport& frame = stats.report;
    const StepReport& sum = frame.sum;
    const Json json = {
        {"frame", stats.frame},
        {"wall_s", stats.wallSeconds},
        {"cpu_s", stats.cpuSeconds},
        {"substeps", frame.steps},
        {"resumed_at_substep", stats.resumedAtSubStep},
        {"step_s", {frame.shortestStep, frame.longestStep}},
        {"limited_by", nameOf(sum.limitedBy)},
        {"fastest_body", bodyName(world, frame.fastestBody)},
        {"substep_cap_reached", frame.substepCapReached},
        {"broad_pairs", sum.broadPairs},
        {"touching_pairs", sum.touchingPairs},
        {"contact_pairs", sum.contactPairs},
        {"contacts", sum.contacts},
        {"levels", sum.levels},
        {"largest_level", sum.largestLevel},
        {"impulses",
         {{"collision", toJson(sum.collisionImpulses)},
          {"contact", toJson(sum.contactImpulses)},
          {"shock", toJson(sum.shockImpulses)}}},
        {"pushes", sum.pushes},
        {"pushes_cut", sum.pushesCut},
        {"loops_at_cap", sum.loopsAtTheirCap},
        {"overlap",
         {{"before_push_out_m", sum.deepestBeforePushOut},
          {"after_push_out_m", sum.deepestAfterPushOut},
          {"worst_ratio", sum.worstOverlapRatio},
          {"bodies", {bodyName(world, sum.worstA), bodyName(world, sum.worstB)}}}},
        {"push_out_work_J", sum.pushOutWork},
        {"kinetic_energy_J", frame.kineticEnergy},
        {"potential_energy_J", frame.potentialEnergy},
        {"momentum", {frame.momentum.x(), frame.momentum.y(), frame.momentum.z()}},
        {"angular_momentum",
         {frame.angularMomentum.x(), frame.angularMomentum.y(), frame.angularMomentum.z()}},
        {"bodies_awake", frame.bodiesAwake},
        {"births",
         {{"born", frame.births.born},
          {"waiting", frame.births.waiting},
          {"skipped", frame.births.skipped}}},
        {"phase_ms", phaseTimes(sum)},
        {"state_hash", toHex(frame.stateHash)},
    };
    return json.dump();
}

std::vector<FrameSummary> readStats(const std::filesystem::path& path)
{
    std::vector<FrameSummary> summaries;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        try {
            summaries.push_back(summaryFromLine(line));
        } catch (const Json::exception&) {
            // Cut by a crash: the frame file decides what exists, the line is only told about it.
        }
    }
    return summaries;
}

}  // namespace scree
