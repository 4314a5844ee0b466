// One frame of a take as a file: cache sample and checkpoint in one. It holds the solver's state
// bit for bit, and beside it the poses of the artist's assets in the shot's unit, so that a reader
// needs nothing else. The layout is documented in io/TAKE_FORMAT.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics/step_observer.h"
#include "core/diagnostics/step_report.h"
#include "core/picture/scene_description.h"
#include "core/scene/body_pair.h"
#include "core/scene/world.h"

namespace scree {

/// What a frame file holds. `motion`, `order`, `bornAt`, `clock` and `contactMemory` are the state
/// (SI); `scene` is what follows from it in the shot's unit, kept because readers outside this
/// program want only that.
struct FrameState {
    std::uint64_t shotHash = 0;  ///< of the resolved shot: a frame belongs to one shot only
    Clock clock;
    std::vector<BodyMotion> motion;
    std::vector<BodyId> order;
    std::vector<std::int32_t> bornAt;  ///< World::bornAt; empty when all are there from the start
    ContactMemory contactMemory;       ///< World::contactMemory; empty for method `paper`
    SceneFrame scene;
    std::vector<SceneFrame> between;   ///< on the way here since the frame before: its number,
                                       ///< offsets ascending in 0 … 1
    std::optional<StepSeen> lastStep;  ///< the step that ended here: on request, and not state
    std::vector<BodyPair> untold;      ///< pairs whose overlaps contacts may not tell of: found at
                                       ///< a look at all poses, and not out since
    FrameReport soFar;                 ///< of a checkpoint: the figures of the steps that led to it
                                       ///< from the frame before, but for times; without, no steps
};

/// The bytes of a frame file, checksum included. Equal states give equal bytes.
std::string encodeFrame(const FrameState& state);

/// The state in `bytes`. Throws Error{inputOutput} naming `path` when they are cut, damaged or of a
/// version that this program does not know.
FrameState decodeFrame(std::string_view bytes, const std::filesystem::path& path);

/// Reads and decodes; Error{missingInput} when there is no such file.
FrameState readFrameFile(const std::filesystem::path& path);

/// The same, but only of that frame: a file copied under another frame's name is refused.
FrameState readFrameFile(const std::filesystem::path& path, int frame);

}  // namespace scree
