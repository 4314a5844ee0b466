#include "tools/start_rule.h"

#include <algorithm>
#include <chrono>

#include "core/base/error.h"
#include "core/dynamics/gaps/start_separation.h"
#include "io/text_forms.h"
#include "tools/pressing_body.h"
#include "tools/stop_signals.h"

namespace scree {
namespace {

/// In a shot that was scattered carelessly hundreds overlap in the same way.
constexpr std::size_t kNamed = 5;

std::string listOf(const std::vector<StartOverlap>& overlaps, const World& world)
{
    std::string text;
    for (const std::string& line : describeWorst(overlaps, world)) text += "\n  " + line;
    return text;
}

std::string sentenceOf(const std::vector<StartOverlap>& overlaps, const World& world)
{
    return std::to_string(overlaps.size()) +
           (overlaps.size() == 1 ? " pair overlaps" : " pairs overlap") +
           " before anything moves:" + listOf(overlaps, world);
}

/// What to do about them. A mesh that looks inward has been turned, and may have been a room.
std::string adviceOn(const std::vector<StartOverlap>& overlaps, const World& world)
{
    std::string text = "\nMove them, or write [start] overlap = \"separate\" or \"warn\"";
    for (const StartOverlap& overlap : overlaps) {
        for (const BodyId body : {overlap.a, overlap.b}) {
            const Shape& shape = world.shapeOf(body);
            if (!shape.repairs.harmless.isTurned) continue;
            return text + "\nThe mesh of shape '" + shape.name +
                   "' was inside-out and has been turned, so that it is full; if it is a room seen "
                   "from inside, write mesh = { repair = \"room\" }";
        }
    }
    return text;
}

/// Thin things that cross take minutes to part: says now and then how many are left, and lets a
/// signal end it.
SeparationProgress progressOn(Console& console)
{
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kBetween{5};
    return [&console, last = Clock::now()](std::size_t pairsLeft) mutable {
        heedStop("nothing was simulated");
        if (Clock::now() - last < kBetween) return;
        last = Clock::now();
        console.info("pushing apart what overlaps: " + std::to_string(pairsLeft) +
                     (pairsLeft == 1 ? " pair left" : " pairs left"));
    };
}

}  // namespace

std::string describe(const StartOverlap& overlap, const World& world)
{
    return world.info[overlap.a].name + " and " + world.info[overlap.b].name +
           formatted(": %.3g m, ", overlap.depth) + percent(overlap.ratio) +
           " of the smaller one's length" + (overlap.isThroughWall ? ", through a wall" : "") +
           describePresser(world, overlap.a, overlap.b);
}

std::vector<std::string> describeWorst(const std::vector<StartOverlap>& overlaps,
                                       const World& world)
{
    std::vector<std::string> lines;
    for (const StartOverlap& overlap : overlaps) {
        if (lines.size() == kNamed) break;
        lines.push_back(describe(overlap, world));
    }
    const std::size_t others = overlaps.size() - lines.size();
    if (others == 0) return lines;
    lines.push_back("and " + std::to_string(others) + " more, by " +
                    percent(overlaps[kNamed].ratio) + " and less");
    return lines;
}

void applyStartRule(const Shot& shot, World& world, Console& console)
{
    const std::vector<StartOverlap> overlaps = findStartOverlaps(world, shot.penetrationWarn);
    if (overlaps.empty()) return;
    const std::string what = sentenceOf(overlaps, world);
    switch (shot.startOverlap) {
        case StartOverlapRule::error:
            throw Error(ErrorKind::badInput, what + adviceOn(overlaps, world));
        case StartOverlapRule::warn:
            console.warning(what);
            return;
        case StartOverlapRule::separate:
            if (!separateAtStart(world, shot.settings, shot.penetrationWarn, progressOn(console))) {
                throw Error(
                    ErrorKind::badInput,
                    what + "\nThey could not be pushed apart; still overlapping are:" +
                        listOf(findStartOverlaps(world, 0.5 * shot.penetrationWarn), world));
            }
            console.info(what + "\nThey were pushed apart");
            return;
    }
}

bool foretellStartRule(const Shot& shot, const World& world,
                       const std::vector<StartOverlap>& overlaps, Console& console)
{
    if (overlaps.empty()) return true;
    const std::string what = sentenceOf(overlaps, world);
    switch (shot.startOverlap) {
        case StartOverlapRule::error:
            console.error(what + adviceOn(overlaps, world));
            return false;
        case StartOverlapRule::warn:
            console.warning(what);
            return true;
        case StartOverlapRule::separate:
            console.info(what + "\nsim pushes them apart, or refuses the shot if it cannot");
            return true;
    }
    return true;
}

}  // namespace scree
