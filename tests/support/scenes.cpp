#include "tests/support/scenes.h"

#include <algorithm>
#include <array>
#include <map>

#include "core/dynamics/integrator.h"
#include "core/geometry/primitives.h"

namespace scree::test {

StepSettings experimentSettings()
{
    StepSettings settings;
    settings.gravity = {0.0, -9.8, 0.0};
    settings.seed = 1;
    return settings;
}

StepSettings screeSettings()
{
    StepSettings settings = experimentSettings();
    settings.method = Method::scree;
    return settings;
}

MaterialId addMaterial(World& world, double friction, double restitution, double density)
{
    return world.addMaterial({"material", density, friction, restitution, {}});
}

BodyId addPlane(World& world, MaterialId material, const Vec3& point, const Vec3& normal)
{
    BodyDefinition definition;
    definition.name = "plane_" + std::to_string(world.bodyCount());
    definition.shape = world.addShape(buildPlaneShape("plane"));
    definition.material = material;
    definition.kind = BodyKind::fixed;
    definition.worldFromAsset = worldFromPlane(point, normal);
    return world.addBody(definition);
}

std::shared_ptr<const Shape> boxShape(const Vec3& size, int segments)
{
    static std::map<std::array<double, 4>, std::shared_ptr<const Shape>> built;
    auto& shape = built[{size.x(), size.y(), size.z(), static_cast<double>(segments)}];
    if (!shape) shape = buildMeshShape("box", makeBox(size, {segments, segments, segments}));
    return shape;
}

std::shared_ptr<const Shape> exactSphere(double radius)
{
    return buildExactShape("sphere", ExactSolid::sphere(radius), makeSphere(radius, 2));
}

std::shared_ptr<const Shape> exactBox(const Vec3& size, int segments)
{
    return buildExactShape("box", ExactSolid::box(size),
                           makeBox(size, {segments, segments, segments}));
}

std::shared_ptr<const Shape> exactCylinder(double radius, double height)
{
    return buildExactShape("cylinder", ExactSolid::cylinder(radius, height),
                           makeCylinder(radius, height, 20, 1));
}

BodyId addBody(World& world, std::shared_ptr<const Shape> shape, MaterialId material,
               const Pose& worldFromAsset, double mass, const Vec3& velocity,
               const Vec3& angularVelocity)
{
    BodyDefinition definition;
    definition.name = "body_" + std::to_string(world.bodyCount());
    definition.shape = world.addShape(std::move(shape));
    definition.material = material;
    definition.kind = mass > 0.0 ? BodyKind::dynamic : BodyKind::fixed;
    definition.worldFromAsset = worldFromAsset;
    definition.velocity = velocity;
    definition.angularVelocity = angularVelocity;
    if (mass > 0.0) definition.mass = mass;
    return world.addBody(definition);
}

Vec3 angularVelocityOf(const World& world, BodyId body)
{
    return angularVelocity(world.motion[body], world.mass[body]);
}

double largestVertexShift(const World& before, const World& after, BodyId body)
{
    const Points& points = after.shapeOf(body).assetMesh.points;
    double largest = 0.0;
    for (Eigen::Index v = 0; v < points.cols(); ++v) {
        const Vec3 p = points.col(v);
        largest = std::max(
            largest, (after.worldFromAsset(body) * p - before.worldFromAsset(body) * p).norm());
    }
    return largest;
}

double totalEnergy(const World& world, const StepSettings& settings)
{
    double energy = 0.0;
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        if (!world.mass[b].isMovable()) continue;
        energy += kineticEnergy(world.motion[b], world.mass[b]);
        energy -= settings.gravity.dot(world.motion[b].position) / world.mass[b].inverseMass;
    }
    return energy;
}

}  // namespace scree::test
