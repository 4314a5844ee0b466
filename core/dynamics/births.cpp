#include "core/dynamics/births.h"

#include <vector>

#include "core/base/check.h"
#include "core/collision/interference.h"
#include "core/dynamics/body_pairs.h"

namespace scree {
namespace {

Aabb boxOf(const World& world, BodyId body)
{
    return boxAt(world.shapeOf(body), world.motion[body].worldFromBody());
}

/// Those who are there, and the boxes they stand in.
class Population {
public:
    explicit Population(const World& world) : world_(world)
    {
        for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
            if (world.isBorn(body)) add(body, boxOf(world, body));
        }
    }

    void add(BodyId body, const Aabb& box)
    {
        bodies_.push_back(body);
        boxes_.push_back(box);
    }

    /// The first body that stands in the way, or −1.
    BodyId occupantOf(BodyId newcomer, const Aabb& box)
    {
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            if (box.overlaps(boxes_[i]) && standsInTheWay(world_, bodies_[i], newcomer))
                return bodies_[i];
        }
        return -1;
    }

private:
    const World& world_;
    std::vector<BodyId> bodies_;
    std::vector<Aabb> boxes_;
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
