#include "core/scene/world.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/check.h"
#include "core/base/error.h"

namespace scree {
namespace {

/// That of a body that is not static [kg/m³].
double densityOf(const BodyDefinition& definition, const Shape& shape, const Material& material)
{
    const double volume = shape.unitMass.volume;
    const double density = definition.mass ? *definition.mass / volume : material.density;
    if (shape.isPlane || !(density * volume > 0.0)) {
        throw Error(ErrorKind::badInput,
                    "body '" + definition.name + "' is not static but " +
                        (shape.isPlane ? "a plane has no mass" : "its mass is not positive"));
    }
    return density;
}

BodyInfo describe(const BodyDefinition& definition, double freeInverseMass)
{
    BodyInfo described;
    described.name = definition.name;
    described.kind = definition.kind;
    described.freeInverseMass = freeInverseMass;
    described.force = definition.force;
    described.torque = definition.torque;
    described.script = definition.script;
    described.keyedFrom = definition.keyedFrom;
    described.keyedUntil = definition.keyedUntil;
    return described;
}

}  // namespace

ShapeId World::addShape(std::shared_ptr<const Shape> shape)
{
    shapes_.push_back(std::move(shape));
    return static_cast<ShapeId>(shapes_.size()) - 1;
}

MaterialId World::addMaterial(Material material)
{
    materials_.push_back(std::move(material));
    return static_cast<MaterialId>(materials_.size()) - 1;
}

BodyId World::addBody(const BodyDefinition& definition)
{
    SCREE_CHECK(definition.shape >= 0 && definition.shape < static_cast<int>(shapes_.size()),
                definition.name);
    SCREE_CHECK(
        definition.material >= 0 && definition.material < static_cast<int>(materials_.size()),
        definition.name);
    const Shape& shape = *shapes_[definition.shape];
    const Pose worldFromBody = definition.worldFromAsset * inverse(shape.bodyFromAsset);
    BodyMotion state;
    state.position = worldFromBody.position;
    state.orientation = worldFromBody.orientation.normalized();

    BodyMass inertia;
    if (definition.kind != BodyKind::fixed) {
        const double density = densityOf(definition, shape, materials_[definition.material]);
        const Vec3 moments = density * shape.unitMass.moments;
        inertia.inverseMass = 1.0 / (density * shape.unitMass.volume);
        inertia.inverseInertia = moments.cwiseInverse();
        state.velocity = definition.velocity;
        const Mat3 rotation = state.orientation.toRotationMatrix();
        state.angularMomentum =
            rotation * moments.asDiagonal() * rotation.transpose() * definition.angularVelocity;
    }

    const auto id = static_cast<BodyId>(motion.size());
    if (definition.birth) {
        SCREE_CHECK(definition.kind == BodyKind::dynamic && !definition.script, definition.name);
        births.push_back({id, definition.birth->frame, definition.birth->clearance, inertia});
        inertia = {};
    }
    motion.push_back(state);
    mass.push_back(inertia);
    bornAt.push_back(definition.birth ? kUnborn : 0);
    traits.push_back({definition.shape, definition.material, definition.groups});
    info.push_back(describe(definition, inertia.inverseMass));
    order.push_back(id);
    if (definition.kind == BodyKind::keyed) {
        SCREE_CHECK(definition.script, definition.name);
        setKind(id, BodyKind::keyed);
        const Pose start = scriptedPose(id, 0.0);
        motion[id] = {start.position, start.orientation, Vec3::Zero(), Vec3::Zero()};
    }
    return id;
}

void World::beBorn(const PlannedBirth& birth)
{
    bornAt[birth.body] = static_cast<std::int32_t>(clock.frame);
    mass[birth.body] = birth.mass;
}

void World::restoreBirths(const std::vector<std::int32_t>& bornAtBefore)
{
    SCREE_CHECK(bornAtBefore.size() == bodyCount(), "births of another world");
    bornAt = bornAtBefore;
    for (const PlannedBirth& birth : births) {
        mass[birth.body] = isBorn(birth.body) ? birth.mass : BodyMass();
    }
}

const BodyMass& World::massWhenBorn(BodyId body) const
{
    const auto birth =
        std::lower_bound(births.begin(), births.end(), body,
                         [](const PlannedBirth& b, BodyId id) { return b.body < id; });
    return birth != births.end() && birth->body == body ? birth->mass : mass[body];
}

double World::massWhenFree(BodyId body) const
{
    const BodyInfo& told = info[body];
    const bool isAlwaysKeyed = told.script && told.keyedFrom <= 0 &&
                               told.keyedUntil == std::numeric_limits<std::int64_t>::max();
    if (isAlwaysKeyed) return 0.0;
    const double inverse = std::max(told.freeInverseMass, massWhenBorn(body).inverseMass);
    return inverse > 0.0 ? 1.0 / inverse : 0.0;
}

void World::setKind(BodyId body, BodyKind kind)
{
    info[body].kind = kind;
    mass[body].inverseMass = kind == BodyKind::dynamic ? info[body].freeInverseMass : 0.0;
}

Pose World::scriptedPose(BodyId body, double atTime) const
{
    return info[body].script->at(atTime) * inverse(shapeOf(body).bodyFromAsset);
}

void World::assignKinds()
{
    for (BodyId body = 0; body < static_cast<BodyId>(bodyCount()); ++body) {
        const BodyInfo& described = info[body];
        if (!described.script) continue;
        const bool isKeyed =
            clock.frame >= described.keyedFrom && clock.frame < described.keyedUntil;
        setKind(body, isKeyed ? BodyKind::keyed : BodyKind::dynamic);

        // Put on the script a body that comes under it in this very moment.
        const bool isFrameStart = clock.subStep == 0 && clock.frameTimeDone == 0.0;
        if (!isKeyed || !isFrameStart || clock.frame != described.keyedFrom) continue;
        const Pose pose = scriptedPose(body, time());
        motion[body].position = pose.position;
        motion[body].orientation = pose.orientation;
    }
}

Pose World::worldFromAsset(BodyId body) const
{
    return motion[body].worldFromBody() * shapeOf(body).bodyFromAsset;
}

}  // namespace scree
