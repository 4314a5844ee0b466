// Candidate pairs from boxes: a tree of most bodies, a list of the few without bounds. [A14]
//
// Boxes move little from step to step, so what is searched are boxes that are somewhat larger, and
// only those of bodies that have left theirs are searched anew. Who is asked for with few others is
// looked up and not entered. The answer never depends on when that was.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/collision/box_tree.h"
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
    enum class Place : char { nowhere, tree, list };  // of a box that is empty, bounded or neither

    static Place placeOf(const Aabb& box);
    std::span<std::vector<BodyPair>> foundBy(std::size_t parts);
    bool areFew(const std::vector<Aabb>& boxes, std::span<const char> isAsked);
    void pairFew(const std::vector<Aabb>& boxes, const std::vector<BodyMass>& mass,
                 const Filter& counts);
    template <class Visit>
    void forThoseNear(const Aabb& box, const Visit& visit) const;
    void findMoved(const std::vector<Aabb>& boxes, const std::vector<BodyMass>& mass);
    void forgetMeetings();
    void enterMoved(const std::vector<Aabb>& boxes);
    void enterAll();
    void pairMoved();
    void pairWithOthers(BodyId moved, std::vector<BodyPair>& found) const;

    // Per body: its larger box and what else is known of it, and whether that is to be found anew.
    std::vector<Aabb> roomy_;
    std::vector<char> isMovable_, isMoved_;
    std::vector<Place> places_;
    BoxTree tree_;
    std::size_t movedSince_ = 0;      // the tree was built
    std::vector<BodyId> unbounded_;   // in no tree
    std::vector<BodyPair> meetings_;  // of the larger boxes, sorted
    std::vector<BodyPair> pairs_;
    // While searching.
    std::vector<BodyId> moved_, asked_, outgrown_;
    std::vector<std::vector<BodyPair>> found_;  // by several threads
};

}  // namespace scree
