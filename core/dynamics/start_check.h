// What can be said of a world before its first step, and what is better said then than after a
// night: bodies that nothing will hold, speeds that the steps cannot follow. Overlaps are told in
// start_overlap.h.
#pragma once

#include <vector>

#include "core/dynamics/settings.h"
#include "core/scene/world.h"

namespace scree {

/// Movable bodies that no static or keyed body they collide with lies under, seen along gravity:
/// unless others hold them they fall for ever. Judged by boxes, so a body beside a hole counts as
/// held. Empty without gravity.
std::vector<BodyId> findUnsupported(const World& world, const Vec3& gravity);

struct FastBody {
    BodyId body = -1;
    double speed = 0.0;        ///< of its surface [m/s]
    double stepsNeeded = 0.0;  ///< per frame
    bool whenItLands = false;  ///< after its fall to what is under it, not at the start
};

/// Movable bodies that need more steps a frame than settings.substeps.max, against bodies at rest
/// and no thinner than themselves; the fastest first.  [A16]
std::vector<FastBody> findTooFast(const World& world, const StepSettings& settings,
                                  double frameDuration);

}  // namespace scree
