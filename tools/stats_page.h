// One page that tells how a take went: plots over its frames, pictures that follow the cursor, and
// the shot. It stands alone: no network, no other file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/take_reader.h"

namespace scree {

/// A small picture of a frame as PNG bytes.
struct Thumbnail {
    int frame = 0;
    std::vector<std::uint8_t> png;
};

/// The page as HTML. Equal arguments give equal bytes. Frames without a line of statistics are left
/// out of the plots.
std::string makeStatsPage(const TakeReader& take, const std::vector<Thumbnail>& thumbnails);

}  // namespace scree
