// What every run does before its first step.
#pragma once

#include "core/scene/world.h"
#include "io/shot.h"
#include "tools/console.h"

namespace scree {

/// The world of a shot with its start rule applied; `noCache`: all shapes are made anew. Told on
/// the way: what was repaired, what may surprise, and what will not do as the shot stands. Throws
/// Error, and Stopped for a signal.
World worldAtStart(const Shot& shot, bool noCache, Console& console);

}  // namespace scree
