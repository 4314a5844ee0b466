#include "core/collision/broad_phase.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"

namespace scree {
namespace {

/// How much larger the boxes are made, on every side. Only time depends on it.
constexpr double kRoom = 0.1;  // of the longest edge

constexpr double kMostCells = 64.0;  // a body over more cells goes to the list of large ones

struct CellRange {
    std::array<std::int64_t, 3> first, last;
    double count() const
    {
        double product = 1.0;
        for (int k = 0; k < 3; ++k) product *= static_cast<double>(last[k] - first[k] + 1);
        return product;
    }
};

std::int64_t cellOf(double coordinate, double cellSize)
{
    // Twenty-one bits a coordinate fit into one key; farther bodies share the outermost cells.
    constexpr double kFarthest = 1 << 20;
    return static_cast<std::int64_t>(
        std::clamp(std::floor(coordinate / cellSize), -kFarthest, kFarthest - 1.0));
}

CellRange cellsOf(const Aabb& box, double cellSize)
{
    CellRange range{};
    for (int k = 0; k < 3; ++k) {
        range.first[k] = cellOf(box.min[k], cellSize);
        range.last[k] = cellOf(box.max[k], cellSize);
    }
    return range;
}

std::uint64_t keyOf(std::int64_t x, std::int64_t y, std::int64_t z)
{
    constexpr std::int64_t kOffset = 1 << 20;
    return static_cast<std::uint64_t>(x + kOffset) << 42 |
           static_cast<std::uint64_t>(y + kOffset) << 21 | static_cast<std::uint64_t>(z + kOffset);
}

}  // namespace

const std::vector<BodyPair>& BroadPhase::findPairs(const std::vector<Aabb>& boxes,
                                                   const std::vector<BodyMass>& mass)
{
    bool isKnown = roomy_.size() == boxes.size();
    for (std::size_t i = 0; i < boxes.size() && isKnown; ++i) {
        isKnown = roomy_[i].contains(boxes[i]) && mass[i].isMovable() == (isMovable_[i] != 0);
    }
    if (!isKnown) {
        roomy_.clear();
        isMovable_.clear();
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const double edge = boxes[i].longestEdge();
            roomy_.push_back(std::isfinite(edge) ? boxes[i].grown(kRoom * edge) : boxes[i]);
            isMovable_.push_back(mass[i].isMovable());
        }
        findRoomyPairs(mass);
    }
    meets_.resize(roomyPairs_.size());
    parallelFor(roomyPairs_.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            meets_[i] = boxes[roomyPairs_[i].a].overlaps(boxes[roomyPairs_[i].b]);
    });
    pairs_.clear();
    for (std::size_t i = 0; i < roomyPairs_.size(); ++i) {
        if (meets_[i]) pairs_.push_back(roomyPairs_[i]);
    }
    return pairs_;
}

void BroadPhase::findRoomyPairs(const std::vector<BodyMass>& mass)
{
    const std::vector<Aabb>& boxes = roomy_;
    found_.clear();
    roomyPairs_.clear();
    entries_.clear();
    large_.clear();
    edges_.clear();
    const auto report = [&](BodyId a, BodyId b) {
        if (!mass[a].isMovable() && !mass[b].isMovable()) return;
        found_.push_back(a < b ? BodyPair{a, b} : BodyPair{b, a});
    };

    for (const Aabb& box : boxes) {
        if (const double edge = box.longestEdge(); std::isfinite(edge)) edges_.push_back(edge);
    }
    if (edges_.empty()) return;
    const auto middle = edges_.begin() + static_cast<std::ptrdiff_t>(edges_.size() / 2);
    std::nth_element(edges_.begin(), middle, edges_.end());
    const double cellSize = std::max(2.0 * *middle, 1e-12);

    firstCells_.resize(boxes.size());
    for (BodyId body = 0; body < static_cast<BodyId>(boxes.size()); ++body) {
        if (boxes[body].isEmpty()) continue;
        const CellRange range = cellsOf(boxes[body], cellSize);
        firstCells_[body] = range.first;
        if (range.count() > kMostCells) {
            large_.push_back(body);
            continue;
        }
        for (std::int64_t x = range.first[0]; x <= range.last[0]; ++x) {
            for (std::int64_t y = range.first[1]; y <= range.last[1]; ++y) {
                for (std::int64_t z = range.first[2]; z <= range.last[2]; ++z) {
                    entries_.push_back({keyOf(x, y, z), body});
                }
            }
        }
    }

    std::sort(entries_.begin(), entries_.end(), [](const Entry& p, const Entry& q) {
        return p.cell < q.cell || (p.cell == q.cell && p.body < q.body);
    });
    for (std::size_t begin = 0; begin < entries_.size();) {
        std::size_t end = begin;
        while (end < entries_.size() && entries_[end].cell == entries_[begin].cell) ++end;
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t j = i + 1; j < end; ++j) {
                if (!boxes[entries_[i].body].overlaps(boxes[entries_[j].body])) continue;
                // Boxes that share several cells meet in the first of them.
                const auto &p = firstCells_[entries_[i].body], &q = firstCells_[entries_[j].body];
                const std::uint64_t first =
                    keyOf(std::max(p[0], q[0]), std::max(p[1], q[1]), std::max(p[2], q[2]));
                if (first == entries_[i].cell) report(entries_[i].body, entries_[j].body);
            }
        }
        begin = end;
    }
    for (std::size_t i = 0; i < large_.size(); ++i) {
        for (BodyId body = 0; body < static_cast<BodyId>(boxes.size()); ++body) {
            // Two large bodies meet once, when the first of them is walked.
            const bool alsoLarge = std::binary_search(large_.begin(), large_.end(), body);
            if (alsoLarge && body <= large_[i]) continue;
            if (boxes[large_[i]].overlaps(boxes[body])) report(large_[i], body);
        }
    }
    sortFound();
}

/// By the first body at a stroke, then the few of each by the second.
void BroadPhase::sortFound()
{
    std::vector<std::size_t> end(roomy_.size() + 1, 0);
    for (const BodyPair& pair : found_) ++end[pair.a + 1];
    for (std::size_t i = 1; i < end.size(); ++i) end[i] += end[i - 1];
    roomyPairs_.resize(found_.size());
    for (const BodyPair& pair : found_) roomyPairs_[end[pair.a]++] = pair;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < roomy_.size(); ++i) {
        std::sort(roomyPairs_.begin() + static_cast<std::ptrdiff_t>(begin),
                  roomyPairs_.begin() + static_cast<std::ptrdiff_t>(end[i]));
        begin = end[i];
    }
}

}  // namespace scree
