#include "tests/support/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "core/base/random.h"
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

std::shared_ptr<const Shape> extruded(const std::vector<Eigen::Vector2d>& outline, double thick,
                                      const Eigen::Vector2d& centre)
{
    const int corners = static_cast<int>(outline.size());
    TriMesh mesh{Points(3, 2 * corners + 2), Triangles(3, 4 * corners)};
    const auto place = [&](int column, const Eigen::Vector2d& point) {
        mesh.points.col(column) << point, -0.5 * thick;
        mesh.points.col(column + 1) << point, 0.5 * thick;
    };
    place(2 * corners, centre);
    for (int i = 0; i < corners; ++i) {
        place(2 * i, outline[i]);
        const int low = 2 * i, high = low + 1, nextLow = 2 * ((i + 1) % corners);
        const int nextHigh = nextLow + 1;
        mesh.triangles.col(4 * i) << low, nextLow, nextHigh;
        mesh.triangles.col(4 * i + 1) << low, nextHigh, high;
        mesh.triangles.col(4 * i + 2) << 2 * corners, nextLow, low;
        mesh.triangles.col(4 * i + 3) << 2 * corners + 1, high, nextHigh;
    }
    return buildMeshShape("extruded", mesh);
}

std::shared_ptr<const Shape> starShape()
{
    std::vector<Eigen::Vector2d> outline;
    for (int i = 0; i < 10; ++i) {
        const double radius = i % 2 ? 0.18 : 0.3, angle = kPi * i / 5.0;
        outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    return extruded(outline, 0.12);
}

std::shared_ptr<const Shape> angleShape()
{
    return extruded({{-0.1, -0.1}, {0.3, -0.1}, {0.3, 0.0}, {0.0, 0.0}, {0.0, 0.3}, {-0.1, 0.3}},
                    0.1, {-0.05, -0.05});
}

std::shared_ptr<const Shape> prismShape()
{
    return extruded({{0.25, 0.0}, {-0.125, 0.216506350946}, {-0.125, -0.216506350946}}, 0.5);
}

std::shared_ptr<const Shape> splinterShape()
{
    return extruded({{0.35, 0.0}, {-0.1, 0.12}, {-0.15, -0.1}}, 0.08);
}

std::shared_ptr<const Shape> binShape(double flare, double height, int walls)
{
    constexpr double kOuterHalf = 1.2, kUnderside = -0.2;
    const std::array<std::pair<double, double>, 4> rims = {{{kOuterHalf, kUnderside},
                                                            {kOuterHalf + flare, height},
                                                            {kBinHalf + flare, height},
                                                            {kBinHalf, 0.0}}};
    TriMesh mesh{Points(3, 4 * walls + 2), Triangles(3, 8 * walls)};
    const int under = 4 * walls, floor = under + 1;
    mesh.points.col(under) = kUnderside * Vec3::UnitY();
    mesh.points.col(floor) = Vec3::Zero();
    int face = 0;
    for (int wall = 0; wall < walls; ++wall) {
        const int next = (wall + 1) % walls;
        const double angle = kPi * (2 * wall - 1) / walls;
        for (int rim = 0; rim < 4; ++rim) {
            const double radius = rims[rim].first / std::cos(kPi / walls);
            mesh.points.col(rim * walls + wall) =
                Vec3(radius * std::cos(angle), rims[rim].second, -radius * std::sin(angle));
        }
        for (int rim = 0; rim < 3; ++rim) {
            const int low = rim * walls, high = low + walls;
            mesh.triangles.col(face++) << low + wall, low + next, high + next;
            mesh.triangles.col(face++) << low + wall, high + next, high + wall;
        }
        mesh.triangles.col(face++) << under, next, wall;
        mesh.triangles.col(face++) << floor, 3 * walls + wall, 3 * walls + next;
    }
    return buildMeshShape("bin", mesh);
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

BodyId addFixed(World& world, MaterialId material, std::shared_ptr<const Shape> shape,
                const Pose& worldFromAsset)
{
    BodyDefinition definition;
    definition.name = "fixed_" + std::to_string(world.bodyCount());
    definition.shape = world.addShape(std::move(shape));
    definition.material = material;
    definition.kind = BodyKind::fixed;
    definition.worldFromAsset = worldFromAsset;
    return world.addBody(definition);
}

BodyId addKeyedBody(World& world, std::shared_ptr<const Shape> shape, MaterialId material,
                    const std::vector<MotionKey>& keys, KeyInterpolation interpolation)
{
    BodyDefinition definition;
    definition.name = "keyed_" + std::to_string(world.bodyCount());
    definition.shape = world.addShape(std::move(shape));
    definition.material = material;
    definition.kind = BodyKind::keyed;
    definition.script = std::make_shared<MotionScript>(keys, interpolation);
    return world.addBody(definition);
}

World stackOfCubes(int count, double topMass)
{
    constexpr double kOffset = 0.01;
    World world;
    const MaterialId material = addMaterial(world, 0.5, 0.3);
    addPlane(world, material);
    for (int i = 0; i < count; ++i) {
        const auto draw = [&](std::uint64_t k) {
            return kOffset * (2.0 * randomUnit(40, static_cast<std::uint64_t>(i), k) - 1.0);
        };
        addBody(world, boxShape({1.0, 1.0, 1.0}, 1), material,
                {Vec3(draw(0), 0.5 + i, draw(1)), Quat::Identity()},
                i + 1 == count ? topMass : 1.0);
    }
    return world;
}

World leaningWall(int columns, int layers)
{
    const Vec3 size(0.25, 0.1, 0.12);
    const double turning = 0.1;  // about its foot [rad/s]
    World world;
    const MaterialId material = addMaterial(world, 0.6, 0.1);
    addPlane(world, material);
    const auto brick = boxShape(size, 1);
    for (int layer = 0; layer < layers; ++layer) {
        const double height = (layer + 0.5) * size.y();
        for (int i = 0; i < columns + layer % 2; ++i) {
            const Vec3 position((i - 0.5 * (layer % 2)) * size.x(), height, 0.0);
            addBody(world, brick, material, {position, Quat::Identity()}, 5.7,
                    {0.0, 0.0, turning * height});
        }
    }
    return world;
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

double deepestOfEdges(const Shape& a, const Shape& b, const Pose& bFromA, int places)
{
    double deepest = 0.0;
    for (const ConvexEdge& edge : a.features.edges()) {
        for (int i = 0; i <= places; ++i) {
            const Vec3 place = edge.start + i * edge.length / places * edge.direction;
            deepest = std::min(deepest, b.distance.value(bFromA * place));
        }
    }
    return deepest;
}

}  // namespace scree::test
