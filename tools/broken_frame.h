// Why a frame that was simulated cannot stand.
#pragma once

#include <string>

#include "core/diagnostics/step_report.h"
#include "core/scene/world.h"

namespace scree {

/// Bodies that are no longer finite, or a birth into what stands there, as a sentence; "" when the
/// frame is whole. `frame` as the shot counts.
std::string complaintOf(const FrameReport& report, const World& world, int frame);

}  // namespace scree
