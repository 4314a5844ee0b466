#include "tools/pressing_body.h"

#include <set>
#include <vector>

namespace scree {
namespace {

bool isKeyed(const World& world, BodyId body)
{
    return world.info[body].kind == BodyKind::keyed;
}

bool moves(const BodyMotion& motion)
{
    return !motion.velocity.isZero(0.0) || !motion.angularMomentum.isZero(0.0);
}

/// The keyed bodies that touch what hangs together with these two. Forces end at what cannot be
/// moved, so that what else that touches is left out.
std::set<BodyId> keyedAround(const World& world, BodyId a, BodyId b)
{
    std::vector<std::vector<BodyId>> touching(world.bodyCount());
    for (const RememberedContact& contact : world.contactMemory.contacts) {
        touching[contact.a].push_back(contact.b);
        touching[contact.b].push_back(contact.a);
    }
    std::set<BodyId> keyed, seen;
    std::vector<BodyId> toVisit = {a, b};
    while (!toVisit.empty()) {
        const BodyId body = toVisit.back();
        toVisit.pop_back();
        if (isKeyed(world, body)) keyed.insert(body);
        if (!world.mass[body].isMovable() || !seen.insert(body).second) continue;
        toVisit.insert(toVisit.end(), touching[body].begin(), touching[body].end());
    }
    return keyed;
}

}  // namespace

std::string describePresser(const World& world, BodyId a, BodyId b)
{
    if (a < 0 || b < 0) return "";
    for (const BodyId body : {a, b})
        if (isKeyed(world, body)) return "; '" + world.info[body].name + kGivesWayToNothing;
    const std::set<BodyId> keyed = keyedAround(world, a, b);
    if (keyed.size() != 1 || !moves(world.motion[*keyed.begin()])) return "";
    return "; '" + world.info[*keyed.begin()].name +
           "', the only one with keys that moves there, presses on them";
}

}  // namespace scree
