#include "core/dynamics/births.h"

#include <algorithm>
#include <vector>

#include "core/base/check.h"
#include "core/collision/box_tree.h"
#include "core/collision/interference.h"
#include "core/dynamics/body_pairs.h"

namespace scree {
namespace {

/// Those who are there, and the boxes they stand in, in the order in which they came. Ten thousand
/// who wait among ten thousand were a third of a second a frame while each looked at all.
class Population {
public:
    explicit Population(const World& world) : world_(world)
    {
        for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
            if (world.isBorn(body)) append(body, boxOf(world, body));
        }
        plant();
    }

    void add(BodyId body, const Aabb& box)
    {
        append(body, box);
        if (apart_.size() > mostApart_) plant();
    }

    /// The first body that stands in the way, or −1.
    BodyId occupantOf(BodyId newcomer, const Aabb& box)
    {
        near_.clear();
        const auto meet = [&](int place) {
            if (box.overlaps(boxes_[place])) near_.push_back(place);
        };
        for (const int place : apart_) meet(place);
        tree_.visit(box, meet);
        std::ranges::sort(near_);
        for (const int place : near_) {
            if (standsInTheWay(world_, bodies_[place], newcomer)) return bodies_[place];
        }
        return -1;
    }

private:
    void append(BodyId body, const Aabb& box)
    {
        apart_.push_back(static_cast<int>(bodies_.size()));
        bodies_.push_back(body);
        boxes_.push_back(box);
    }

    /// A tree of all who have bounds; apart from it stay the others.
    void plant()
    {
        // Enough may come before the next one that planting takes no longer than looking.
        constexpr std::size_t kBetween = 200;
        apart_.clear();
        std::vector<int> bounded;
        for (int place = 0; place < static_cast<int>(boxes_.size()); ++place)
            (boxes_[place].size().allFinite() ? bounded : apart_).push_back(place);
        tree_.build(bounded, boxes_);
        mostApart_ = apart_.size() + kBetween;
    }

    const World& world_;
    std::vector<BodyId> bodies_;
    std::vector<Aabb> boxes_;
    BoxTree tree_;  // of places in these lists
    std::vector<int> apart_, near_;
    std::size_t mostApart_ = 0;
};

std::vector<PlannedBirth> dueBirths(const World& world)
{
    std::vector<PlannedBirth> due;
    for (const PlannedBirth& birth : world.births) {
        const bool isDue = birth.frame <= world.clock.frame;
        if (isDue && world.bornAt[birth.body] == kUnborn) due.push_back(birth);
    }
    return due;
}

}  // namespace

bool standsInTheWay(const World& world, BodyId body, BodyId newcomer)
{
    if (!acceptEachOther(world, {newcomer, body})) return false;
    const double tau = contourValue(world.shapeOf(newcomer), world.shapeOf(body));
    return deepestTouch(placePair(world, {newcomer, body}), tau).has_value();
}

BirthReport giveBirths(World& world)
{
    SCREE_CHECK(world.clock.subStep == 0, "births happen between frames");
    BirthReport report;
    const std::vector<PlannedBirth> due = dueBirths(world);
    if (due.empty()) return report;

    Population population(world);
    for (const PlannedBirth& birth : due) {
        const Aabb box = boxOf(world, birth.body);
        const BodyId occupant = population.occupantOf(birth.body, box);
        if (occupant < 0) {
            world.beBorn(birth);
            population.add(birth.body, box);
            ++report.born;
        } else if (birth.clearance == BirthClearance::wait) {
            ++report.waiting;
        } else if (birth.clearance == BirthClearance::skip) {
            world.bornAt[birth.body] = kSkipped;
            ++report.skipped;
        } else {
            report.failed = birth.body;
            report.occupant = occupant;
            return report;
        }
    }
    return report;
}

}  // namespace scree
