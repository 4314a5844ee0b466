#include "core/dynamics/gaps/contact_load.h"

namespace scree {

Unbalance::Unbalance(const World& world, BodyId body, const ContactLoad& load,
                     const AppliedForce& other)
    : force((load.force + other.acceleration / world.mass[body].inverseMass).norm()),
      torque((load.torque + other.torque).norm())
{
}

bool isBalanced(const World& world, BodyId body, const ContactLoad& load, const AppliedForce& other,
                double share)
{
    const Unbalance rest(world, body, load, other);
    const double allowed = share * load.total;
    return rest.force <= allowed && rest.torque <= allowed * world.shapeOf(body).boundingRadius;
}

}  // namespace scree
