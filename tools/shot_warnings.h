// What will not do as the shot stands, told before its first frame.
#pragma once

#include <string>
#include <vector>

#include "core/scene/world.h"
#include "io/shot.h"

namespace scree {

/// Bodies that nothing holds, speeds beyond the cap, sizes that tell of another unit, and what the
/// shot's files held that is lost. One sentence each.
std::vector<std::string> warningsBeforeStart(const Shot& shot, const World& world);

/// What may well be meant, and surprises whoever meant something else: keyed bodies that are let go
/// at rest where their keys have only just ended. One sentence each, located.
std::vector<std::string> notesBeforeStart(const Shot& shot);

}  // namespace scree
