// Whether all that emitters promise can come before the shot ends.
#pragma once

#include <string>
#include <vector>

#include "core/scene/world.h"
#include "io/shot.h"

namespace scree {

/// A sentence for each emitter of which bodies will still wait at the last frame, or be left out,
/// even if everything falls freely out of the way of what comes after it: with where it stands in
/// the shot's file and how many. `world` stands at time zero. What is blocked for ever by something
/// static is not counted; where fields of force act nothing is foretold.
std::vector<std::string> foretellBirths(const Shot& shot, const World& world);

}  // namespace scree
