// Bodies that come into the world while the shot runs.
//
// Births happen between frames only: a body is there, untouched, in the picture of the frame it is
// born at, and moves from then on. Who may be born is decided by the same interference test that
// the passes use, so that no birth makes an overlap.
#pragma once

#include "core/diagnostics/step_report.h"
#include "core/scene/world.h"

namespace scree {

/// Whether a body stands where another is to be born. Their boxes are not compared.
bool standsInTheWay(const World& world, BodyId body, BodyId newcomer);

/// Lets in every body that is due at the frame the clock shows and whose place is free, in order of
/// their ids: of two that want the same place the first gets it. For the others their clearance
/// decides; one that may not wait ends the search and is named. The clock stands between frames.
BirthReport giveBirths(World& world);

}  // namespace scree
