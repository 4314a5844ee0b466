#include "core/dynamics/body_pairs.h"

#include <algorithm>

#include "core/collision/relative_pair.h"
#include "core/dynamics/rolling_friction.h"

namespace scree {
namespace {

const MaterialPair* exceptionFor(const World& world, BodyPair bodies)
{
    const MaterialId a = world.traits[bodies.a].material, b = world.traits[bodies.b].material;
    for (const MaterialPair& pair : world.materialPairs) {
        if ((pair.a == a && pair.b == b) || (pair.a == b && pair.b == a)) return &pair;
    }
    return nullptr;
}

}  // namespace

PairSurface surfaceOf(const World& world, const StepSettings& settings, BodyPair bodies)
{
    const Material& a = world.materialOf(bodies.a);
    const Material& b = world.materialOf(bodies.b);
    PairSurface surface{combined(settings.frictionRule, a.friction, b.friction),
                        combined(settings.restitutionRule, a.restitution, b.restitution),
                        largerOf(a.rolling, b.rolling)};
    if (const MaterialPair* special = exceptionFor(world, bodies)) {
        surface.friction = special->friction.value_or(surface.friction);
        surface.restitution = special->restitution.value_or(surface.restitution);
    }
    return surface;
}

bool acceptEachOther(const World& world, BodyPair bodies)
{
    const CollisionGroups &a = world.traits[bodies.a].groups, &b = world.traits[bodies.b].groups;
    return (a.collidesWith & b.group) && (b.collidesWith & a.group);
}

bool isUnmovedBy(const World& world, BodyId body, BodyId other)
{
    return (world.traits[body].groups.unmovedBy & world.traits[other].groups.group) != 0;
}

bool mayCollide(const World& world, BodyPair bodies)
{
    const auto isMovedBy = [&](BodyId body, BodyId other) {
        return world.mass[body].isMovable() && !isUnmovedBy(world, body, other);
    };
    return acceptEachOther(world, bodies) &&
           (isMovedBy(bodies.a, bodies.b) || isMovedBy(bodies.b, bodies.a));
}

std::optional<Vec3> normalOfPlane(const World& world, BodyPair bodies)
{
    for (const BodyId body : {bodies.a, bodies.b}) {
        if (world.shapeOf(body).isPlane) return world.motion[body].orientation * Vec3::UnitY();
    }
    return {};
}

Aabb boxOf(const World& world, BodyId body)
{
    return boxAt(world.shapeOf(body), world.motion[body].worldFromBody());
}

double smallerRadius(const World& world, BodyId a, BodyId b)
{
    return smallerRadius(world.shapeOf(a), world.shapeOf(b));
}

double smallerEdge(const World& world, BodyId a, BodyId b)
{
    return std::min(world.shapeOf(a).longestEdge(), world.shapeOf(b).longestEdge());
}

double overlapRatio(const World& world, BodyPair bodies, double depth)
{
    return depth / smallerEdge(world, bodies.a, bodies.b);
}

void WorstOverlap::include(const World& world, BodyPair bodies, double depthOfPair)
{
    if (depthOfPair <= 0.0) return;
    include({depthOfPair, overlapRatio(world, bodies, depthOfPair), bodies.a, bodies.b});
}

void WorstOverlap::include(const WorstOverlap& other)
{
    depth = std::max(depth, other.depth);
    if (other.ratio <= ratio) return;
    ratio = other.ratio;
    a = other.a;
    b = other.b;
}

PlacedPair placePair(const World& world, BodyPair bodies)
{
    const auto [a, b] = bodies;
    return {&world.shapeOf(a), &world.shapeOf(b), world.motion[a].worldFromBody(),
            world.motion[b].worldFromBody()};
}

}  // namespace scree
