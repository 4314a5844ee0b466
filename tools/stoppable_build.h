// Signals while the shapes of a shot are made, which can take minutes.
#pragma once

#include "io/build_world.h"
#include "io/shape_cache.h"
#include "tools/console.h"

namespace scree {

/// What a run says that is stopped meanwhile.
inline constexpr const char* kStoppedBeforeFrames =
    "stopped before the first frame; nothing was written: run the same again";

/// For when there is nothing to save yet: says so to who asks for it, and throws Stopped.
void heedEarlySignals(Console& console);

/// The world of a shot, with shapes from `cache`; what keeps that from its work is warned of.
/// Signals are heeded before and after each solid and distance field, and at the end; one to stop
/// within seconds also inside of one, by ending the program. What takes long is told now and then.
World buildStoppably(const Shot& shot, ShapeCache& cache, Console& console);

}  // namespace scree
