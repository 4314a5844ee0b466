// What the contacts of a body do to it, and whether that balances what else acts on it: of this
// sleep lives.  [algorithm 14]
#pragma once

#include <vector>

#include "core/dynamics/body_pairs.h"
#include "core/dynamics/forces.h"

namespace scree {

/// What does not balance of the forces on a body, as a share of those of its contacts: below the
/// first it may fall asleep, above the second it wakes; in between, when that lasts. What sleeps
/// for good hardly changes the load of its neighbours; what comes to lie on a body of its own
/// weight adds a third. Sweeps over a heap may leave a hundredth (gap_contact.cpp).
inline constexpr double kBalanced = 0.02, kUnbalanced = 0.1;

struct ContactLoad {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< about its centre, world [N], [N m]
    double total = 0.0;                                ///< of the magnitudes of the forces [N]

    /// A force at r from the centre, and a couple.
    void add(const Vec3& r, const Vec3& f, const Vec3& couple)
    {
        force += f;
        torque += r.cross(f) + couple;
        total += f.norm();
    }
};

/// Per body, of the remembered contacts that counts(a, b) accepts, and that it feels.
template <class Counts>
std::vector<ContactLoad> rememberedLoads(const World& world, const Counts& counts)
{
    std::vector<ContactLoad> loads(world.bodyCount());
    for (const RememberedContact& contact : world.contactMemory.contacts) {
        if (!counts(contact.a, contact.b)) continue;
        const BodyMotion &a = world.motion[contact.a], &b = world.motion[contact.b];
        const Vec3 r = a.orientation * contact.place;
        if (!isUnmovedBy(world, contact.a, contact.b))
            loads[contact.a].add(r, contact.force, contact.couple);
        if (!isUnmovedBy(world, contact.b, contact.a))
            loads[contact.b].add(a.position + r - b.position, -contact.force, -contact.couple);
    }
    return loads;
}

/// What remains of the forces on a body when those that hold it are taken off.
struct Unbalance {
    double force, torque;  ///< [N], [N m]

    Unbalance(const World& world, BodyId body, const ContactLoad& load, const AppliedForce& other);
};

/// Whether the forces on a body cancel but for a share of those of its contacts.
bool isBalanced(const World& world, BodyId body, const ContactLoad& load, const AppliedForce& other,
                double share);

}  // namespace scree
