#include "core/collision/broad_phase.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/sorted.h"

namespace scree {
namespace {

/// How much larger the boxes are made, on every side, and how large they may be when their bodies
/// need less by and by: what has fallen fast leaves no large box behind. Only time depends on it.
constexpr double kRoom = 0.1, kMostRoomy = 1.5;  // of the longest edge

/// Cells are this many of the longest edges of the body in the middle, and are laid out anew when
/// they are so many times too large or too small.
constexpr double kEdgesPerCell = 2.0, kMostMisfit = 2.0;
constexpr double kSmallestCell = 1e-12;  // [m]

constexpr std::size_t kEntriesTogether = 512, kMeetingsTogether = 1024;  // by one thread

constexpr double kMostCells = 64.0;  // a body over more cells goes to the list of large ones

/// One in so many bodies, or fewer, is looked for by itself. Only time depends on it.
constexpr std::size_t kFewAmong = 32;

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

/// Puts the sorted tail that begins at `middle` among the sorted rest.
template <class Item>
void mergeTail(std::vector<Item>& items, std::size_t middle)
{
    const auto tail = items.begin() + static_cast<std::ptrdiff_t>(middle);
    std::sort(tail, items.end());
    std::inplace_merge(items.begin(), tail, items.end());
}

void appendAll(std::span<const std::vector<BodyPair>> lists, std::vector<BodyPair>& all)
{
    for (const std::vector<BodyPair>& list : lists) all.insert(all.end(), list.begin(), list.end());
}

}  // namespace

const std::vector<BodyPair>& BroadPhase::findPairs(const std::vector<Aabb>& boxes,
                                                   const std::vector<BodyMass>& mass,
                                                   const Filter& counts,
                                                   std::span<const char> isAsked)
{
    if (!isAsked.empty() && areFew(boxes, isAsked)) {
        pairFew(boxes, mass, counts);
        return pairs_;
    }
    if (findMoved(boxes, mass)) {
        forEach(2, 1, [&](std::size_t list) {
            if (list == 0)
                enterMoved(boxes);
            else
                forgetMeetings();
        });
        pairMoved();
    }
    const auto found = foundBy((meetings_.size() + kMeetingsTogether - 1) / kMeetingsTogether);
    forEach(found.size(), 1, [&](std::size_t part) {
        const std::size_t begin = part * kMeetingsTogether;
        const std::size_t end = std::min(begin + kMeetingsTogether, meetings_.size());
        // Which of them overlap cannot be guessed: no branch.
        std::vector<BodyPair>& overlapping = found[part];
        overlapping.resize(kMeetingsTogether);
        std::size_t count = 0;
        for (std::size_t i = begin; i < end; ++i) {
            overlapping[count] = meetings_[i];
            count += boxes[meetings_[i].a].overlaps(boxes[meetings_[i].b]);
        }
        overlapping.resize(count);
        std::erase_if(overlapping, [&](const BodyPair& pair) {
            const bool isOne = isAsked.empty() || isAsked[pair.a] || isAsked[pair.b];
            return !isOne || !counts(pair);
        });
    });
    pairs_.clear();
    appendAll(found, pairs_);
    return pairs_;
}

/// A list for each of so many parts of a search. Those of a larger search keep their memory.
std::span<std::vector<BodyPair>> BroadPhase::foundBy(std::size_t parts)
{
    if (found_.size() < parts) found_.resize(parts);
    return std::span(found_).first(parts);
}

/// Lists the bodies that are asked, and those that no longer are where they have been entered;
/// answers whether they are few.
bool BroadPhase::areFew(const std::vector<Aabb>& boxes, std::span<const char> isAsked)
{
    if (roomy_.size() != boxes.size()) return false;
    asked_.clear();
    outgrown_.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (isAsked[i]) asked_.push_back(static_cast<BodyId>(i));
        if (!roomy_[i].contains(boxes[i])) outgrown_.push_back(static_cast<BodyId>(i));
    }
    return kFewAmong * std::max(asked_.size(), outgrown_.size()) <= boxes.size();
}

/// The pairs of those that are asked: in the cells that their boxes cover, and among those that are
/// in none. Nobody is entered anew.
void BroadPhase::pairFew(const std::vector<Aabb>& boxes, const std::vector<BodyMass>& mass,
                         const Filter& counts)
{
    const auto found = foundBy(asked_.size());
    forEach(asked_.size(), 1, [&](std::size_t n) {
        const BodyId asked = asked_[n];
        found[n].clear();
        const auto meetBoxOf = [&](BodyId other) {
            if (other == asked || !boxes[asked].overlaps(boxes[other])) return;
            if (!mass[asked].isMovable() && !mass[other].isMovable()) return;
            const BodyPair pair{std::min(asked, other), std::max(asked, other)};
            if (counts(pair)) found[n].push_back(pair);
        };
        for (const BodyId other : large_) meetBoxOf(other);
        for (const BodyId other : outgrown_) meetBoxOf(other);
        forThoseWithin(boxes[asked], meetBoxOf);
    });
    pairs_.clear();
    appendAll(found, pairs_);
    sortUnique(pairs_);
}

/// Calls visit(body) for those that have been entered in the cells of a box, or for all where these
/// are many; for some again and again.
template <class Visit>
void BroadPhase::forThoseWithin(const Aabb& box, const Visit& visit) const
{
    if (box.isEmpty()) return;
    const CellRange range = cellsOf(box, cellSize_);
    if (range.count() > kMostCells) {
        for (BodyId body = 0; body < static_cast<BodyId>(roomy_.size()); ++body) visit(body);
        return;
    }
    for (std::int64_t x = range.first[0]; x <= range.last[0]; ++x) {
        for (std::int64_t y = range.first[1]; y <= range.last[1]; ++y) {
            for (std::int64_t z = range.first[2]; z <= range.last[2]; ++z) {
                const auto inCell =
                    std::ranges::equal_range(entries_, keyOf(x, y, z), {}, &Entry::cell);
                for (const Entry& entry : inCell) visit(entry.body);
            }
        }
    }
}

/// Marks the bodies that no longer fit their boxes; where cells no longer fit the bodies, all.
bool BroadPhase::findMoved(const std::vector<Aabb>& boxes, const std::vector<BodyMass>& mass)
{
    const bool isKnown = roomy_.size() == boxes.size();
    if (!isKnown) {
        // Of another world: what it has entered may name bodies that this one has not.
        entries_.clear();
        large_.clear();
        meetings_.clear();
    }
    roomy_.resize(boxes.size());
    isMovable_.resize(boxes.size());
    isMoved_.assign(boxes.size(), !isKnown);
    bool isAny = !isKnown;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const char isMovable = mass[i].isMovable();
        const bool fits = roomy_[i].contains(boxes[i]) &&
                          roomy_[i].longestEdge() <= kMostRoomy * boxes[i].longestEdge();
        if (fits && isMovable == isMovable_[i]) continue;
        isMovable_[i] = isMovable;
        isMoved_[i] = isAny = true;
    }
    if (!isAny) return false;

    edges_.clear();
    for (const Aabb& box : boxes) {
        if (const double edge = box.longestEdge(); std::isfinite(edge)) edges_.push_back(edge);
    }
    if (edges_.empty()) return true;
    const auto middle = edges_.begin() + static_cast<std::ptrdiff_t>(edges_.size() / 2);
    std::nth_element(edges_.begin(), middle, edges_.end());
    const double fitting = std::max(kEdgesPerCell * *middle, kSmallestCell);
    if (std::max(fitting, cellSize_) > kMostMisfit * std::min(fitting, cellSize_)) {
        cellSize_ = fitting;
        isMoved_.assign(boxes.size(), true);
    }
    return true;
}

void BroadPhase::forgetMeetings()
{
    std::erase_if(meetings_,
                  [&](const BodyPair& pair) { return isMoved_[pair.a] || isMoved_[pair.b]; });
}

/// Into the cells where they are now.
void BroadPhase::enterMoved(const std::vector<Aabb>& boxes)
{
    std::erase_if(entries_, [&](const Entry& entry) { return isMoved_[entry.body] != 0; });
    std::erase_if(large_, [&](BodyId body) { return isMoved_[body] != 0; });
    const std::size_t stay = entries_.size(), stayLarge = large_.size();
    firstCells_.resize(boxes.size());
    for (BodyId body = 0; body < static_cast<BodyId>(boxes.size()); ++body) {
        if (!isMoved_[body]) continue;
        const double edge = boxes[body].longestEdge();
        roomy_[body] = std::isfinite(edge) ? boxes[body].grown(kRoom * edge) : boxes[body];
        if (boxes[body].isEmpty()) continue;
        const CellRange range = cellsOf(roomy_[body], cellSize_);
        firstCells_[body] = range.first;
        if (range.count() > kMostCells) {
            large_.push_back(body);
            continue;
        }
        for (std::int64_t x = range.first[0]; x <= range.last[0]; ++x) {
            for (std::int64_t y = range.first[1]; y <= range.last[1]; ++y) {
                for (std::int64_t z = range.first[2]; z <= range.last[2]; ++z)
                    entries_.push_back({keyOf(x, y, z), body});
            }
        }
    }
    mergeTail(entries_, stay);
    mergeTail(large_, stayLarge);
}

/// Pairs of which one has moved at least, each once.
void BroadPhase::pairMoved()
{
    // Parts of the entries begin where a cell does.
    const auto firstOfCell = [&](std::size_t i) {
        while (i > 0 && i < entries_.size() && entries_[i].cell == entries_[i - 1].cell) ++i;
        return std::min(i, entries_.size());
    };
    const auto found = foundBy((entries_.size() + kEntriesTogether - 1) / kEntriesTogether);
    forEach(found.size(), 1, [&](std::size_t part) {
        found[part].clear();
        pairInCells(firstOfCell(part * kEntriesTogether),
                    firstOfCell((part + 1) * kEntriesTogether), found[part]);
    });
    const std::size_t stay = meetings_.size();
    appendAll(found, meetings_);
    pairLarge(meetings_);
    mergeTail(meetings_, stay);
}

/// Pairs of those that share a cell, among the entries from `begin` to `end`.
void BroadPhase::pairInCells(std::size_t begin, std::size_t end, std::vector<BodyPair>& found) const
{
    thread_local std::vector<BodyId> movedHere;
    for (std::size_t next = begin; begin < end; begin = next) {
        movedHere.clear();
        for (; next < end && entries_[next].cell == entries_[begin].cell; ++next) {
            if (isMoved_[entries_[next].body]) movedHere.push_back(entries_[next].body);
        }
        for (const BodyId moved : movedHere) {
            for (std::size_t i = begin; i < next; ++i) {
                const BodyId other = entries_[i].body;
                if (isMoved_[other] && other <= moved) continue;
                if (!roomy_[moved].overlaps(roomy_[other])) continue;
                // Boxes that share several cells meet in the first of them.
                const auto &p = firstCells_[moved], &q = firstCells_[other];
                const std::uint64_t first =
                    keyOf(std::max(p[0], q[0]), std::max(p[1], q[1]), std::max(p[2], q[2]));
                if (first == entries_[i].cell) meet(moved, other, found);
            }
        }
    }
}

void BroadPhase::pairLarge(std::vector<BodyPair>& found) const
{
    for (const BodyId large : large_) {
        for (BodyId body = 0; body < static_cast<BodyId>(roomy_.size()); ++body) {
            if (!isMoved_[large] && !isMoved_[body]) continue;
            // Two large bodies meet once, when the first of them is walked.
            if (body <= large && std::binary_search(large_.begin(), large_.end(), body)) continue;
            if (roomy_[large].overlaps(roomy_[body])) meet(large, body, found);
        }
    }
}

void BroadPhase::meet(BodyId a, BodyId b, std::vector<BodyPair>& found) const
{
    if (!isMovable_[a] && !isMovable_[b]) return;
    found.push_back(a < b ? BodyPair{a, b} : BodyPair{b, a});
}

}  // namespace scree
