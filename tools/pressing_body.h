// Who is to blame for an overlap: what has keys goes its way, and what stands in it gives way or is
// pressed into something else.
#pragma once

#include <string>

#include "core/scene/world.h"

namespace scree {

/// What is said after the name of a keyed body that overlaps another.
inline constexpr const char* kGivesWayToNothing = "' has keys and gives way to nothing";

/// "; 'lid' has keys and gives way to nothing" of two bodies that overlap, if one of them is keyed
/// now; else "; 'lid', the only one with keys that moves there, presses on them" of what they hang
/// together with, as method `scree` remembers it from the last step. Empty when it is neither.
std::string describePresser(const World& world, BodyId a, BodyId b);

}  // namespace scree
