// Candidate pairs from boxes: a uniform grid for most bodies, a list for the few that are huge.
// [A14]
//
// Boxes move little from step to step, so the search is for boxes that are somewhat larger, and
// serves until one leaves its own. The answer never depends on when that was.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math/aabb.h"
#include "core/scene/body.h"

namespace scree {

/// Always a < b.
struct BodyPair {
    BodyId a = 0, b = 0;
    friend bool operator==(const BodyPair&, const BodyPair&) = default;
    friend auto operator<=>(const BodyPair&, const BodyPair&) = default;
};

class BroadPhase {
public:
    /// All pairs whose boxes overlap and of which at least one body is movable, sorted, each once.
    /// The result stays valid until the next call.
    const std::vector<BodyPair>& findPairs(const std::vector<Aabb>& boxes,
                                           const std::vector<BodyMass>& mass);

private:
    struct Entry {
        std::uint64_t cell;
        BodyId body;
    };
    void findRoomyPairs(const std::vector<BodyMass>& mass);
    void sortFound();

    std::vector<Aabb> roomy_;                   // the boxes of the last search
    std::vector<char> isMovable_;               // then
    std::vector<BodyPair> found_, roomyPairs_;  // as found, and sorted
    std::vector<char> meets_;                   // of each of these: whether the boxes asked for do
    std::vector<Entry> entries_;
    std::vector<std::array<std::int64_t, 3>> firstCells_;  // of each body
    std::vector<BodyId> large_;
    std::vector<double> edges_;
    std::vector<BodyPair> pairs_;
};

}  // namespace scree
