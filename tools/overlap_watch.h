// What a run finds out about overlaps and says of them, while it goes on and at its end.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics/step_report.h"
#include "core/dynamics/start_overlap.h"
#include "core/scene/body_pair.h"
#include "core/scene/world.h"
#include "io/frame_stats.h"
#include "io/shot.h"
#include "tools/console.h"

namespace scree {

/// What goes on for many frames is a warning in the first alone: a night's log stays short.
void warnOnce(Console& console, bool& wasTold, const std::string& text);

/// A step knows overlaps by the contacts it found, and is silent about what it did not find. So
/// every two seconds of the shot, and in its last frame, the poses are looked at afresh: the points
/// of every body in the field of every other. What is found there is looked at in every frame from
/// then on, until it is out; frames keep which pairs these are, so that a run that was interrupted
/// goes on looking.
class OverlapWatch {
public:
    /// All three must outlive the watch; the world is that of the run, as it goes on.
    OverlapWatch(const Shot& shot, const World& world, Console& console);

    /// Pairs that the last look at poses has found, and that are not out since.
    const std::vector<BodyPair>& untold() const { return untold_; }
    void goOnLookingAt(std::vector<BodyPair> untold) { untold_ = std::move(untold); }

    /// Looks at the poses, all or those of the untold, and takes what it finds into the figures of
    /// the frame that has just ended. What goes through a wall is warned of.
    void lookAtPoses(int frame, FrameReport& report);

    /// Warns of an overlap beyond the shot's limits; each grade is told once, when it happens.
    void warn(int frame, const FrameReport& report);

    /// Looks over the whole take, earlier sittings included, up to `lastFrame`. False, and an
    /// error, when a frame broke the limit; how the first one overlaps is for start.overlap to
    /// judge.
    bool judge(const std::vector<FrameSummary>& frames, int lastFrame) const;

private:
    std::vector<StartOverlap> stillOverlapping();
    void warnOfWall(int frame, const StartOverlap& overlap);
    std::string framesBeyond(const std::vector<FrameSummary>& frames, int lastFrame,
                             const std::string& name, double limit, std::size_t least) const;

    std::string keyedIn(const FrameSummary& frame) const;

    const Shot& shot_;
    const World& world_;
    Console& console_;
    std::vector<BodyPair> untold_;
    std::optional<OverlapMeasure> measure_;  // of world_, once asked for
    bool toldWarning_ = false, toldFailure_ = false, toldWall_ = false;
};

}  // namespace scree
