#include "tools/overlap_watch.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "io/text_forms.h"
#include "tools/pressing_body.h"
#include "tools/start_rule.h"

namespace scree {
namespace {

/// Worst frames named when a limit was broken.
constexpr std::size_t kNamedFrames = 5;

}  // namespace

void warnOnce(Console& console, bool& wasTold, const std::string& text)
{
    if (wasTold)
        console.detail(text);
    else
        console.warning(text);
    wasTold = true;
}

OverlapWatch::OverlapWatch(const Shot& shot, const World& world, Console& console)
    : shot_(shot), world_(world), console_(console)
{
}

void OverlapWatch::lookAtPoses(int frame, FrameReport& report)
{
    const int every = std::max(1, static_cast<int>(std::lround(2.0 * shot_.framesPerSecond)));
    const bool isLook = (frame - shot_.firstFrame) % every == 0 || frame == shot_.lastFrame;
    const std::vector<StartOverlap> overlaps =
        isLook ? findStartOverlaps(world_, report.sum.worstOverlapRatio) : stillOverlapping();
    untold_.clear();
    for (const StartOverlap& overlap : overlaps) {
        untold_.push_back({overlap.a, overlap.b});
        report.sum.deepestAfterPushOut = std::max(report.sum.deepestAfterPushOut, overlap.depth);
        // Of the first frame start.overlap has told.
        if (overlap.isThroughWall && frame > shot_.firstFrame) warnOfWall(frame, overlap);
    }
    if (overlaps.empty() || overlaps.front().ratio <= report.sum.worstOverlapRatio) return;
    report.sum.worstOverlapRatio = overlaps.front().ratio;
    report.sum.worstA = overlaps.front().a;
    report.sum.worstB = overlaps.front().b;
}

/// Those of the untold that overlap now, the worst ratio first.
std::vector<StartOverlap> OverlapWatch::stillOverlapping()
{
    if (untold_.empty()) return {};
    if (!measure_) measure_.emplace(world_);
    std::vector<StartOverlap> still;
    for (const BodyPair& bodies : untold_) {
        if (const auto now = (*measure_)(bodies, placePair(world_, bodies), 0.0))
            still.push_back(*now);
    }
    std::ranges::stable_sort(still, std::ranges::greater{}, &StartOverlap::ratio);
    return still;
}

void OverlapWatch::warn(int frame, const FrameReport& report)
{
    const double ratio = report.sum.worstOverlapRatio;
    if (ratio <= shot_.penetrationWarn) return;
    const bool isFailure = ratio > shot_.penetrationFail;
    const auto bodyName = [&](BodyId body) {
        return body >= 0 ? world_.info[body].name : std::string("?");
    };
    const std::string text =
        "frame " + std::to_string(frame) + ": " + bodyName(report.sum.worstA) + " and " +
        bodyName(report.sum.worstB) + " overlap by " + percent(ratio) +
        " of the smaller one's length, " +
        (isFailure ? "beyond penetration.fail; the run goes on" : "beyond penetration.warn") +
        describePresser(world_, report.sum.worstA, report.sum.worstB);
    warnOnce(console_, isFailure ? toldFailure_ : toldWarning_, text);
}

/// What has come there seldom comes out again.
void OverlapWatch::warnOfWall(int frame, const StartOverlap& overlap)
{
    const std::string text = "frame " + std::to_string(frame) + ": " + describe(overlap, world_);
    warnOnce(console_, toldWall_, text);
}

bool OverlapWatch::judge(const std::vector<FrameSummary>& frames, int lastFrame) const
{
    const std::string failed =
        framesBeyond(frames, lastFrame, "penetration.fail", shot_.penetrationFail, 1);
    // The first has been told.
    const std::string warned =
        framesBeyond(frames, lastFrame, "penetration.warn", shot_.penetrationWarn, 2);
    if (failed.empty() && !warned.empty()) console_.warning(warned);
    if (!failed.empty()) console_.error(failed);
    return failed.empty();
}

/// What to say of frames that overlap by more than a limit, the worst first; empty: fewer than
/// `least` do.
std::string OverlapWatch::framesBeyond(const std::vector<FrameSummary>& frames, int lastFrame,
                                       const std::string& name, double limit,
                                       std::size_t least) const
{
    std::vector<FrameSummary> broken;
    for (const FrameSummary& frame : frames)
        if (frame.frame > shot_.firstFrame && frame.frame <= lastFrame &&
            frame.overlapRatio > limit)
            broken.push_back(frame);
    if (broken.size() < least) return "";
    std::stable_sort(broken.begin(), broken.end(),
                     [](const auto& a, const auto& b) { return a.overlapRatio > b.overlapRatio; });
    std::string text = std::to_string(broken.size()) +
                       (broken.size() == 1 ? " frame overlaps" : " frames overlap") +
                       " by more than " + name + " = " + percent(limit) + "; worst:";
    for (std::size_t i = 0; i < std::min(broken.size(), kNamedFrames); ++i)
        text += (i == 0 ? " " : "; ") + std::to_string(broken[i].frame) + " (" + broken[i].worstA +
                ", " + broken[i].worstB + ": " + percent(broken[i].overlapRatio) + ")";
    return text + keyedIn(broken.front());
}

/// Of the worst frame, which may be long past.
std::string OverlapWatch::keyedIn(const FrameSummary& frame) const
{
    const int sinceStart = frame.frame - shot_.firstFrame;
    for (const BodyInfo& body : world_.info) {
        const bool isOne = body.name == frame.worstA || body.name == frame.worstB;
        if (isOne && body.script && body.keyedFrom <= sinceStart && sinceStart <= body.keyedUntil)
            return "; '" + body.name + kGivesWayToNothing;
    }
    return "";
}

}  // namespace scree
