// Candidate pairs from boxes: a uniform grid for most bodies, a list for the few that are huge.
// [A14]
//
// Boxes move little from step to step, so what is searched are boxes that are somewhat larger, and
// only those of bodies that have left theirs are searched anew. Who is asked for with few others is
// looked up and not entered. The answer never depends on when that was.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/math/aabb.h"
#include "core/scene/body.h"
#include "core/scene/body_pair.h"

namespace scree {

class BroadPhase {
public:
    /// Which pairs count; called by several threads at once.
    using Filter = std::function<bool(BodyPair)>;

    /// All pairs that count whose boxes overlap and of which at least one body is movable, sorted,
    /// each once; with `isAsked`, per body, only those of which one is. The result stays valid
    /// until the next call.
    const std::vector<BodyPair>& findPairs(const std::vector<Aabb>& boxes,
                                           const std::vector<BodyMass>& mass, const Filter& counts,
                                           std::span<const char> isAsked = {});

private:
    struct Entry {
        std::uint64_t cell;
        BodyId body;
        friend auto operator<=>(const Entry&, const Entry&) = default;
    };
    std::span<std::vector<BodyPair>> foundBy(std::size_t parts);
    bool areFew(const std::vector<Aabb>& boxes, std::span<const char> isAsked);
    void pairFew(const std::vector<Aabb>& boxes, const std::vector<BodyMass>& mass,
                 const Filter& counts);
    template <class Visit>
    void forThoseWithin(const Aabb& box, const Visit& visit) const;
    bool findMoved(const std::vector<Aabb>& boxes, const std::vector<BodyMass>& mass);
    void forgetMeetings();
    void enterMoved(const std::vector<Aabb>& boxes);
    void pairMoved();
    void pairInCells(std::size_t begin, std::size_t end, std::vector<BodyPair>& found) const;
    void pairLarge(std::vector<BodyPair>& found) const;
    void meet(BodyId a, BodyId b, std::vector<BodyPair>& found) const;

    // Per body: its larger box and what else is known of it, and whether that is to be found anew.
    std::vector<Aabb> roomy_;
    std::vector<char> isMovable_, isMoved_;
    std::vector<std::array<std::int64_t, 3>> firstCells_;
    double cellSize_ = 1.0;           // [m]
    std::vector<Entry> entries_;      // sorted
    std::vector<BodyId> large_;       // sorted; in no cell
    std::vector<BodyPair> meetings_;  // of the larger boxes, sorted
    std::vector<BodyPair> pairs_;
    // While searching.
    std::vector<double> edges_;
    std::vector<BodyId> asked_, outgrown_;
    std::vector<std::vector<BodyPair>> found_;  // by several threads
};

}  // namespace scree
