// Where settled props lie as .poses files, which a [[body]] or [[emitter]] of another shot reads.
#pragma once

#include <string>
#include <vector>

#include "core/picture/scene_description.h"
#include "core/scene/world.h"
#include "io/shot.h"

namespace scree {

struct PosesFile {
    std::string path;
    std::string text;
};

/// Throws Error{usage} when some of what moves in the shot is no copy of an item: the nodes of an
/// [[import]] have shapes of their own; or when two of its files would have one name.
void requirePosableBodies(const Shot& shot, const std::string& output);

/// A file holds copies of one body: one for each [[body]] and [[emitter]] that moves, and each of
/// its shapes. The only one is called `output`; of "heap.poses", several are "heap_ring.poses",
/// "heap_block.poses", or for the shapes of one emitter "heap_rubble_brick.poses". Who is not born
/// is in none.
std::vector<PosesFile> settledPoses(const Shot& shot, const World& world, const SceneFrame& frame,
                                    const std::string& output);

}  // namespace scree
