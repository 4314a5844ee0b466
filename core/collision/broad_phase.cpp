#include "core/collision/broad_phase.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/base/sorted.h"

namespace scree {
namespace {

/// How much larger the boxes are made, on every side, and how large they may be when their bodies
/// need less by and by: what has fallen fast leaves no large box behind. Only time depends on it.
constexpr double kRoom = 0.1, kMostRoomy = 1.5;  // of the longest edge

/// The tree is built anew when so many have moved for each that is in it: that takes about as long
/// as to look for them. Only time depends on it.
constexpr std::size_t kMostMoved = 1;

constexpr std::size_t kMovedTogether = 16, kMeetingsTogether = 1024;  // by one thread

/// One in so many bodies, or fewer, is looked for by itself. Only time depends on it.
constexpr std::size_t kFewAmong = 32;

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
    findMoved(boxes, mass);
    if (!moved_.empty()) {
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

/// The pairs of those that are asked, by the boxes they have now. Nobody is entered anew.
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
        for (const BodyId other : outgrown_) meetBoxOf(other);
        forThoseNear(boxes[asked], meetBoxOf);
    });
    pairs_.clear();
    appendAll(found, pairs_);
    sortUnique(pairs_);
}

BroadPhase::Place BroadPhase::placeOf(const Aabb& box)
{
    if (box.isEmpty()) return Place::nowhere;
    return box.size().allFinite() ? Place::tree : Place::list;
}

/// Calls visit(body) for all whose larger boxes overlap this one, and for some others.
template <class Visit>
void BroadPhase::forThoseNear(const Aabb& box, const Visit& visit) const
{
    if (placeOf(box) == Place::list) {  // which also overlaps those that are nowhere
        for (BodyId body = 0; body < static_cast<BodyId>(roomy_.size()); ++body) visit(body);
        return;
    }
    for (const BodyId body : unbounded_) visit(body);
    tree_.visit(box, visit);
}

/// Lists the bodies that no longer fit their boxes.
void BroadPhase::findMoved(const std::vector<Aabb>& boxes, const std::vector<BodyMass>& mass)
{
    const bool isKnown = roomy_.size() == boxes.size();
    if (!isKnown) {
        // Of another world: what it has met may name bodies that this one has not.
        meetings_.clear();
        places_.assign(boxes.size(), Place::nowhere);
        enterAll();
    }
    roomy_.resize(boxes.size());
    isMovable_.resize(boxes.size());
    isMoved_.assign(boxes.size(), 0);
    moved_.clear();
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const char isMovable = mass[i].isMovable();
        const bool fits = isKnown && roomy_[i].contains(boxes[i]) &&
                          roomy_[i].longestEdge() <= kMostRoomy * boxes[i].longestEdge();
        if (fits && isMovable == isMovable_[i]) continue;
        isMovable_[i] = isMovable;
        isMoved_[i] = 1;
        moved_.push_back(static_cast<BodyId>(i));
    }
}

void BroadPhase::forgetMeetings()
{
    std::erase_if(meetings_,
                  [&](const BodyPair& pair) { return isMoved_[pair.a] || isMoved_[pair.b]; });
}

/// Where they are now.
void BroadPhase::enterMoved(const std::vector<Aabb>& boxes)
{
    bool areSame = true;
    for (const BodyId body : moved_) {
        const Aabb& box = boxes[body];
        const Place place = placeOf(box);
        roomy_[body] = place == Place::tree ? box.grown(kRoom * box.longestEdge()) : box;
        areSame = areSame && place == places_[body];
        places_[body] = place;
    }
    movedSince_ += moved_.size();
    if (areSame && movedSince_ <= kMostMoved * boxes.size())
        tree_.refit(roomy_);
    else
        enterAll();
}

void BroadPhase::enterAll()
{
    thread_local std::vector<BodyId> bounded;
    bounded.clear();
    unbounded_.clear();
    for (BodyId body = 0; body < static_cast<BodyId>(places_.size()); ++body) {
        if (places_[body] == Place::tree) bounded.push_back(body);
        if (places_[body] == Place::list) unbounded_.push_back(body);
    }
    tree_.build(bounded, roomy_);
    movedSince_ = 0;
}

/// Pairs of which one has moved at least, each once.
void BroadPhase::pairMoved()
{
    const auto found = foundBy((moved_.size() + kMovedTogether - 1) / kMovedTogether);
    forEach(found.size(), 1, [&](std::size_t part) {
        found[part].clear();
        const std::size_t end = std::min((part + 1) * kMovedTogether, moved_.size());
        for (std::size_t i = part * kMovedTogether; i < end; ++i)
            pairWithOthers(moved_[i], found[part]);
    });
    const std::size_t stay = meetings_.size();
    appendAll(found, meetings_);
    mergeTail(meetings_, stay);
}

void BroadPhase::pairWithOthers(BodyId moved, std::vector<BodyPair>& found) const
{
    forThoseNear(roomy_[moved], [&](BodyId other) {
        // Two that have moved meet once, when the first of them looks around.
        if (isMoved_[other] && other <= moved) return;
        if (!isMovable_[moved] && !isMovable_[other]) return;
        if (!roomy_[moved].overlaps(roomy_[other])) return;
        found.push_back({std::min(moved, other), std::max(moved, other)});
    });
}

}  // namespace scree
