// What can be said of a world before its first step, and what is better said then than after a
// night: overlaps, bodies that nothing will hold, speeds that the steps cannot follow.
#pragma once

#include <vector>

#include "core/dynamics/settings.h"
#include "core/scene/world.h"

namespace scree {

struct StartOverlap {
    BodyId a = -1, b = -1;
    double depth = 0.0;          ///< [m]
    double ratio = 0.0;          ///< of the smaller body's longest box edge [-]
    bool isThroughWall = false;  ///< nearly as deep as anything can be in what is thin of either:
                                 ///< contacts seldom lead out of there
};

/// Pairs that overlap by more than `leastRatio`, or through a wall however little that is of their
/// size, of which one at least is movable and both are there; the worst ratio first.
std::vector<StartOverlap> findStartOverlaps(const World& world, double leastRatio);

/// Pushes bodies apart, without giving them velocity, until nothing overlaps by more than half of
/// `leastRatio` or through a wall; false when that does not come about. Bodies that overlap nothing
/// stay where they are.
bool separateAtStart(World& world, const StepSettings& settings, double leastRatio);

/// Movable bodies that no static or keyed body lies under, seen along gravity: unless others hold
/// them they fall for ever. Judged by boxes, so a body beside a hole counts as held. Empty without
/// gravity.
std::vector<BodyId> findUnsupported(const World& world, const Vec3& gravity);

struct FastBody {
    BodyId body = -1;
    double speed = 0.0;        ///< of its surface [m/s]
    double stepsNeeded = 0.0;  ///< per frame
    bool whenItLands = false;  ///< after its fall to the static body under it, not at the start
};

/// Movable bodies that need more steps a frame than settings.substeps.max, against bodies at rest
/// and no thinner than themselves; the fastest first.  [A16]
std::vector<FastBody> findTooFast(const World& world, const StepSettings& settings,
                                  double frameDuration);

}  // namespace scree
