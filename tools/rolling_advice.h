// What is round and is braked by nothing rolls until it meets something: so says physics, and few
// expect it of a barrel on a lawn.
#pragma once

#include <string>
#include <vector>

#include "core/scene/world.h"
#include "io/shot.h"

namespace scree {

/// Whether a body that moves is round about some axis, and neither its material nor that of
/// anything that bodies roll on resists rolling.
bool rollsOn(const World& world, BodyId body);

/// One sentence for each material of bodies that roll on, with a number that would stop them.
std::vector<std::string> rollingAdvice(const Shot& shot, const World& world);

}  // namespace scree
