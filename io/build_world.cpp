#include "io/build_world.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/dynamics/births.h"
#include "core/dynamics/gaps/sleep.h"
#include "core/dynamics/integrator.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "io/mesh_import.h"
#include "io/plane_mesh.h"
#include "io/problem_list.h"

namespace scree {
namespace {

/// The mesh of a shape in the artist's frame [m], without its scale; assets within their limits.
struct MeshMaker {
    double metresPerUnit = 1.0;
    ImportLimits limits;

    TriMesh operator()(const TorusSpec& s) const { return makeTorus(s.major, s.minor, s.segments); }
    TriMesh operator()(const BoxSpec& s) const { return makeBox(s.size, s.segments); }
    TriMesh operator()(const SphereSpec& s) const { return makeSphere(s.radius, s.subdivisions); }
    TriMesh operator()(const CylinderSpec& s) const
    {
        return makeCylinder(s.radius, s.height, s.sectors, s.bands);
    }
    TriMesh operator()(const CapsuleSpec& s) const
    {
        return makeCapsule(s.radius, s.height, s.sectors, s.rings);
    }
    TriMesh operator()(const FileSpec& s) const
    {
        const ImportedFile file = importFile(s.path, limits);
        const double metres = file.metresPerUnit.value_or(metresPerUnit);
        return transformed(joinedMesh(file, s.path), Pose(), Vec3::Constant(metres));
    }
    TriMesh operator()(const NodeSpec& s) const { return *s.mesh; }
};

/// The exact solid of a shape that has one, scale included.
struct SolidMaker {
    Vec3 scale;

    std::optional<ExactSolid> operator()(const SphereSpec& s) const
    {
        return ExactSolid::sphere(scale.x() * s.radius);
    }
    std::optional<ExactSolid> operator()(const BoxSpec& s) const
    {
        return ExactSolid::box(scale.cwiseProduct(s.size));
    }
    std::optional<ExactSolid> operator()(const CylinderSpec& s) const
    {
        return ExactSolid::cylinder(scale.x() * s.radius, scale.y() * s.height);
    }
    template <class Other>
    std::optional<ExactSolid> operator()(const Other&) const
    {
        return std::nullopt;
    }
};

/// With so many nodes thin things meet by method `scree` as with any more: its contacts are places
/// on meshes, and distances near a surface are asked of the mesh. A wall of two hundred shards fell
/// alike with 100 000 and with 2 million for each. With twelve voxels across the thinnest part of
/// every shard, as the samples of the paper need them, four were refused, and the others took twice
/// the time to start and the memory. With 250 000 a thousand cubes in a bin took an eighth longer:
/// where cells are wide more triangles are near.
constexpr std::size_t kEnoughNodes = 1'000'000;

/// And of all shapes together: a wall of a thousand shards, each with as many as one alone may
/// have, took a minute and a half and 3 GB to start.
constexpr std::size_t kEnoughNodesOfAll = 50'000'000;

/// A shape in the making.
struct ShapeWork {
    const ShotShape* shape;
    TriMesh mesh = {}, colliding = {};
    std::shared_ptr<const Shape> made = nullptr;
    std::exception_ptr problem = nullptr;  // instead
    std::optional<ShapeId> id = {};        // in the world
    bool isAsked = false;

    /// Does a part of it; what is wrong with the shape ends it.
    template <class Work>
    void attempt(const Work& work)
    {
        if (problem) return;
        try {
            work();
        } catch (const std::bad_alloc&) {
            problem = std::current_exception();
        } catch (const Error&) {
            problem = std::current_exception();
        }
    }
};

/// Shapes with no more triangles than this share of what there is for each thread are made side by
/// side, each by one thread: of a small one there is little to share out.
constexpr double kSmallShare = 0.25;

/// Bodies, materials and the shapes that bodies need, in the order of the shot.
class WorldBuilder {
public:
    WorldBuilder(const Shot& shot, ShapeStore* store)
        : shot_(shot), store_(store), problems_(fileOf(shot))
    {
        std::unordered_map<std::string, const ShotShape*> shapeNamed;
        for (const ShotShape& shape : shot.shapes) shapeNamed.emplace(shape.name, &shape);
        for (const ShotBody& body : shot.bodies) {
            if (body.shape && workOfName_.try_emplace(*body.shape, works_.size()).second)
                works_.push_back({shapeNamed.at(*body.shape)});
        }
        enoughNodes_ =
            std::min(kEnoughNodes, kEnoughNodesOfAll / std::max<std::size_t>(works_.size(), 1));
    }

    World build()
    {
        for (const ShotMaterial& material : shot_.materials) {
            materialOfName_.emplace(material.material.name, world_.addMaterial(material.material));
        }
        for (const ShotPair& pair : shot_.pairs) {
            world_.materialPairs.push_back({materialOfName_.at(pair.a), materialOfName_.at(pair.b),
                                            pair.friction, pair.restitution});
        }
        world_.fields = shot_.fields;
        world_.frameDuration = 1.0 / shot_.framesPerSecond;
        makeShapes();
        for (const ShotBody& body : shot_.bodies) add(body);
        problems_.throwIfAny();
        bearTheFirst();
        problems_.throwIfAny();
        sleepFromTheStart(world_, shot_.settings, sleepers_);
        setKeyedBodiesOff(world_);
        return std::move(world_);
    }

private:
    static std::string fileOf(const Shot& shot)
    {
        return shot.bodies.empty() ? "" : shot.bodies.front().location.file;
    }

    void add(const ShotBody& body)
    {
        const std::optional<ShapeId> shape =
            body.plane ? planeShape() : meshShape(works_[workOfName_.at(*body.shape)]);
        if (!shape) return;
        BodyDefinition definition;
        definition.name = body.name;
        definition.shape = *shape;
        definition.material = materialOfName_.at(body.material);
        definition.kind = body.kind;
        definition.worldFromAsset = body.plane
                                        ? worldFromPlane(body.plane->point, body.plane->normal)
                                        : body.worldFromAsset;
        definition.velocity = body.velocity;
        definition.angularVelocity = body.angularVelocity;
        definition.mass = body.mass;
        definition.force = body.force;
        definition.torque = body.torque;
        definition.groups = body.groups;
        if (body.kind == BodyKind::keyed) {
            definition.script = std::make_shared<MotionScript>(body.keys, body.interpolation);
            if (body.keyedFromFrame) {
                definition.kind = BodyKind::dynamic;  // until then
                definition.keyedFrom = *body.keyedFromFrame - shot_.firstFrame;
            }
            if (body.releaseFrame) definition.keyedUntil = *body.releaseFrame - shot_.firstFrame;
        }
        if (body.birth) {
            definition.birth = {body.birth->frame - shot_.firstFrame, body.birth->clearance};
        }
        try {
            const BodyId added = world_.addBody(definition);
            if (body.startsAsleep) sleepers_.push_back(added);
        } catch (const Error& error) {
            problems_.add(body.location, error.what(), error.kind());
        }
    }

    /// Births at time zero; bodies of world and shot have the same order.
    void bearTheFirst()
    {
        const BirthReport report = giveBirths(world_);
        if (report.failed < 0) return;
        problems_.add(shot_.bodies[report.failed].location,
                      "'" + world_.info[report.failed].name + "' cannot be born: '" +
                          world_.info[report.occupant].name +
                          "' stands in its place; clear = \"wait\" lets it wait");
    }

    ShapeId planeShape()
    {
        if (!plane_) plane_ = world_.addShape(buildPlaneShape(planeName()));
        return *plane_;
    }

    /// "plane", unless the shot has a shape of that name.
    std::string planeName() const
    {
        std::string name = "plane";
        const auto isTaken = [&](const ShotShape& shape) { return shape.name == name; };
        while (std::ranges::any_of(shot_.shapes, isTaken)) name += "_";
        return name;
    }

    /// Nothing when the shape could not be made; that is told once, not for every body.
    std::optional<ShapeId> meshShape(ShapeWork& work)
    {
        if (std::exchange(work.isAsked, true)) return work.id;
        const ShotShape& shape = *work.shape;
        try {
            if (work.problem) std::rethrow_exception(work.problem);
            work.id = world_.addShape(work.made);
        } catch (const std::bad_alloc&) {
            throw Error(ErrorKind::internal,
                        "memory ran out while the shape '" + shape.name + "' was built");
        } catch (const Error& error) {
            problems_.add(shape.location, error.what() + adviceFor(shape, error.what()),
                          error.kind());
        }
        return work.id;
    }

    void makeMeshes(ShapeWork& work) const
    {
        const ShotShape& shape = *work.shape;
        const MeshMaker maker{shot_.metresPerUnit, shot_.importLimits};
        work.mesh = transformed(std::visit(maker, shape.source), Pose(), shape.scale);
        // Points that fell together would be told as holes and faces without area, which nobody
        // finds in the file.
        constexpr double kMostRounding = 0.01;
        if (const std::string rough = roughnessOf(work.mesh, kMostRounding); !rough.empty()) {
            throw Error(ErrorKind::badInput, "shape '" + shape.name + "' " + rough);
        }
        if (shape.collision)
            work.colliding = transformed(maker(*shape.collision), Pose(), shape.scale);
    }

    void makeShapes()
    {
        for (ShapeWork& work : works_) work.attempt([&] { makeMeshes(work); });
        const auto trianglesOf = [](const ShapeWork& work) {
            return work.mesh.triangles.cols() + work.colliding.triangles.cols();
        };
        Eigen::Index all = 0;
        for (const ShapeWork& work : works_) all += trianglesOf(work);
        const double most = kSmallShare * static_cast<double>(all) / threadCount();
        std::vector<ShapeWork*> small;
        for (ShapeWork& work : works_) {
            if (static_cast<double>(trianglesOf(work)) <= most)
                small.push_back(&work);
            else
                makeShape(work);
        }
        forEach(small.size(), 1, [&](std::size_t i) { makeShape(*small[i]); });
    }

    void makeShape(ShapeWork& work) const
    {
        work.attempt([&] { work.made = shapeOf(*work.shape, work.mesh, work.colliding); });
        work.mesh = work.colliding = {};
    }

    /// What is wrong with a mesh is told with keys that may help: in an import, they help all.
    static std::string adviceFor(const ShotShape& shape, const std::string& message)
    {
        const bool namesKeys = message.find(" = { ") != std::string::npos;
        if (!std::holds_alternative<NodeSpec>(shape.source) || !namesKeys) return "";
        return "; a key of an [[import]] holds for all of its nodes: one that needs another has an "
               "[[import]] of its own";
    }

    ShapeSettings settingsOf(const ShotShape& shape) const
    {
        ShapeSettings settings = shape.settings;
        if (shot_.settings.method == Method::scree && settings.field == FieldMode::refined)
            settings.enoughNodes = enoughNodes_;
        return settings;
    }

    std::shared_ptr<const Shape> shapeOf(const ShotShape& shape, const TriMesh& mesh,
                                         const TriMesh& colliding) const
    {
        const ShapeSettings settings = settingsOf(shape);
        if (shape.collision) return buildMeshShape(shape.name, mesh, colliding, settings, store_);
        if (shape.isExact) {
            if (const auto solid = std::visit(SolidMaker{shape.scale}, shape.source)) {
                return buildExactShape(shape.name, *solid, mesh, settings);
            }
        }
        return buildMeshShape(shape.name, mesh, settings, store_);
    }

    const Shot& shot_;
    ShapeStore* store_;
    std::size_t enoughNodes_;  // of a field, by method `scree`
    ProblemList problems_;
    World world_;
    std::vector<BodyId> sleepers_;
    std::vector<ShapeWork> works_;  // in the order in which bodies need their shapes
    // Asked by name, never walked.
    std::unordered_map<std::string, std::size_t> workOfName_;
    std::unordered_map<std::string, MaterialId> materialOfName_;
    std::optional<ShapeId> plane_;
};

SceneMesh toSceneMesh(const Shape& shape, double metresPerUnit, double planeHalfWidth)
{
    if (shape.isPlane) return makePlaneMesh(shape.name, planeHalfWidth);
    const TriMesh& mesh = shape.assetMesh;
    return {shape.name, mesh.points / metresPerUnit, mesh.triangles, mesh.cornerUvs};
}

}  // namespace

std::string roughnessOf(const TriMesh& mesh, double share)
{
    constexpr double kRounding = 6e-8;  // of a coordinate
    constexpr double kSmallest = 1e-9;  // what is no longer is told of elsewhere
    if (mesh.points.cols() == 0 || !mesh.points.allFinite()) return "";
    const double farthest = mesh.points.cwiseAbs().maxCoeff();
    const double longest =
        (mesh.points.rowwise().maxCoeff() - mesh.points.rowwise().minCoeff()).maxCoeff();
    if (longest < kSmallest || kRounding * farthest <= share * longest) return "";
    char text[256];
    std::snprintf(text, sizeof text,
                  "lies %.3g m from the origin of its file, where single precision is exact to "
                  "%.2g m only, and is %.2g m long: move it to the origin there",
                  farthest, kRounding * farthest, longest);
    return text;
}

World buildWorld(const Shot& shot, ShapeStore* store)
{
    return WorldBuilder(shot, store).build();
}

SceneDescription describeScene(const Shot& shot, const World& world, double planeHalfWidth)
{
    SceneDescription scene;
    scene.name = shot.name;
    scene.framesPerSecond = shot.framesPerSecond;
    scene.metresPerUnit = shot.metresPerUnit;
    scene.zUp = shot.zUp;

    // Meshes in the order in which bodies first use them.
    std::unordered_map<const Shape*, std::size_t> meshOf;
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const auto body = static_cast<BodyId>(i);
        const Shape& shape = world.shapeOf(body);
        const auto [entry, isNew] = meshOf.try_emplace(&shape, scene.meshes.size());
        if (isNew) {
            scene.meshes.push_back(toSceneMesh(shape, shot.metresPerUnit, planeHalfWidth));
        }
        SceneBody described;
        described.name = world.info[i].name;
        described.mesh = entry->second;
        described.material = world.materialOf(body).name;
        described.moves = world.info[i].kind != BodyKind::fixed;
        described.mass = world.massWhenFree(body);
        described.isVisible = shot.bodies[i].isVisible;
        scene.bodies.push_back(described);
    }
    return scene;
}

// Symbols: x centre of mass, v its velocity, w angular velocity.
SceneFrame captureFrame(const Shot& shot, const World& world)
{
    SceneFrame frame;
    frame.frame = shot.firstFrame + static_cast<int>(world.clock.frame);
    for (std::size_t i = 0; i < world.bodyCount(); ++i) {
        const BodyMotion& motion = world.motion[i];
        const Mat3 rotation = motion.orientation.toRotationMatrix();
        const Mat3 inverseInertia = inverseInertiaWorld(rotation, world.mass[i].inverseInertia);
        const Vec3 w = inverseInertia * motion.angularMomentum;

        Pose pose = world.worldFromAsset(static_cast<BodyId>(i));
        // Before its birth a body stands still where it will begin.
        const bool isBorn = world.isBorn(static_cast<BodyId>(i));
        const Vec3 v = isBorn ? (motion.velocity + w.cross(pose.position - motion.position)).eval()
                              : Vec3::Zero().eval();
        pose.position /= shot.metresPerUnit;
        frame.worldFromAsset.push_back(pose);
        frame.velocity.push_back(v / shot.metresPerUnit);
        frame.angularVelocity.push_back(w);
    }
    return frame;
}

}  // namespace scree
