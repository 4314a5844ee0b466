// Symbols: x centre of mass, v velocity, u velocity of the air against the body, a acceleration,
//          d distance, k share of u that drag takes away per second [1/s].
#include "core/dynamics/forces.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace scree {
namespace {

constexpr double kAirDensity = 1.2;  // at 20 °C and sea level [kg/m³]

double strengthAt(const ForceField& field, double time)
{
    const auto& keys = field.keys;
    if (keys.empty()) return field.strength;
    if (time <= keys.front().time) return keys.front().strength;
    if (time >= keys.back().time) return keys.back().strength;
    const auto next =
        std::upper_bound(keys.begin(), keys.end(), time,
                         [](double t, const StrengthKey& key) { return t < key.time; });
    const StrengthKey& before = *(next - 1);
    const double share = (time - before.time) / (next->time - before.time);
    return before.strength + share * (next->strength - before.strength);
}

double weightAt(const ForceField& field, double d)
{
    const double s = d / field.reach;
    switch (field.falloff) {
        case Falloff::none:
            return 1.0;
        case Falloff::linear:
            return std::max(0.0, 1.0 - s);
        case Falloff::smooth: {
            const double left = std::max(0.0, 1.0 - s * s);
            return left * left;
        }
        case Falloff::inverseSquare:
            return 1.0 / (1.0 + s * s);
    }
    return 1.0;
}

Vec3 unitOrZero(const Vec3& a)
{
    const double length = a.norm();
    return length > 0.0 ? Vec3(a / length) : Vec3(Vec3::Zero());
}

}  // namespace

Vec3 fieldAcceleration(const ForceField& field, double time, const Vec3& x, const Vec3& v,
                       double airGrip, double dt)
{
    const double strength = strengthAt(field, time);
    const Vec3 fromCentre = x - field.centre;
    switch (field.kind) {
        case ForceField::Kind::radial:
            return strength * weightAt(field, fromCentre.norm()) * unitOrZero(fromCentre);
        case ForceField::Kind::vortex: {
            const Vec3 fromAxis = fromCentre - fromCentre.dot(field.direction) * field.direction;
            return strength * weightAt(field, fromAxis.norm()) *
                   field.direction.cross(unitOrZero(fromAxis));
        }
        case ForceField::Kind::uniform:
            return strength * weightAt(field, fromCentre.norm()) * field.direction;
        case ForceField::Kind::wind: {
            const Vec3 air = strength * weightAt(field, fromCentre.norm()) * field.direction;
            const Vec3 u = air - v;
            const double k = field.drag * airGrip * u.norm();
            return k / (1.0 + k * dt) * u;
        }
    }
    return Vec3::Zero();
}

void findForces(const World& world, const StepSettings& settings, double dt,
                std::vector<AppliedForce>& forces)
{
    forces.resize(world.bodyCount());
    // Method `scree` moves a body on a parabola, which is only as good as the force is that of the
    // whole step: with that of its beginning what swings through a point of attraction swings three
    // times as far after 20 s. The paper moves it with the new velocity, which does not gain.
    const double later = settings.method == Method::scree ? 0.5 * dt : 0.0;
    const double time = world.time(later);
    std::vector<char> touches(world.bodyCount(), 0);
    for (const RememberedContact& contact : world.contactMemory.contacts)
        touches[contact.a] = touches[contact.b] = 1;
    forEach(world.bodyCount(), kShortWork, [&](std::size_t b) {
        forces[b] = {};
        if (!world.mass[b].isMovable()) return;
        const BodyMotion& motion = world.motion[b];
        const std::uint64_t group = world.traits[b].groups.group;
        const double inverseMass = world.mass[b].inverseMass;
        const double area = 0.25 * world.shapeOf(static_cast<BodyId>(b)).unitMass.area;
        const double airGrip = 0.5 * kAirDensity * area * inverseMass;
        forces[b].acceleration = settings.gravity + inverseMass * world.info[b].force;
        // What is touched moves with its new velocity: there a force of the middle of the step
        // takes its turning about the middle of the field, of a heap of rocks 3 % of that in a
        // second.
        const Vec3 position =
            touches[b] ? motion.position : Vec3(motion.position + later * motion.velocity);
        const auto add = [&](bool isWind, const Vec3& velocity) {
            Vec3 sum = Vec3::Zero();
            for (const ForceField& field : world.fields) {
                if ((field.kind == ForceField::Kind::wind) != isWind) continue;
                if ((field.groups & group) == 0) continue;
                sum += fieldAcceleration(field, time, position, velocity, airGrip, dt);
            }
            forces[b].acceleration += sum;
        };
        add(false, motion.velocity);
        // Air takes from the speed of the middle of the step: told of that of its beginning, what
        // falls through it ended g dt/2 too fast, a leaf a fifth. What lies there does not fall.
        const Vec3 gained = later * forces[b].acceleration;
        add(true, motion.velocity + (touches[b] ? Vec3(Vec3::Zero()) : gained));
        forces[b].torque = world.info[b].torque;
    });
}

void addForces(World& world, const std::vector<AppliedForce>& forces, double dt)
{
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        if (!world.mass[b].isMovable()) continue;
        world.motion[b].velocity += dt * forces[b].acceleration;
        world.motion[b].angularMomentum += dt * forces[b].torque;
    }
}

}  // namespace scree
