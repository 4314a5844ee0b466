#include "core/geometry/shape.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/geometry/ground_solid.h"
#include "core/geometry/level_set_build.h"
#include "core/geometry/mesh_defects.h"
#include "core/geometry/primitives.h"
#include "core/geometry/revolution.h"
#include "core/geometry/room_solid.h"
#include "core/geometry/shape_store.h"
#include "core/geometry/solidified_sheet.h"
#include "core/math/point_box.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

constexpr int kLeastResolution = 48;  // [A4]
constexpr int kLeastVoxels = 8, kMostResolution = 512;
constexpr double kVoxelsPerThickness = 12.0;
constexpr int kMarginCells = 4;                // around the mesh
constexpr int kRepairResolution = 64;          // of the lattice of a wrap, unless the shot says
constexpr double kRepairVoxelsPerShell = 3.0;  // fewer tear the shell where it bends

/// The length of a ray from a face inward to the opposite wall, at most the shortest box edge; by
/// area, up to where it is exceeded.
class Walls {
public:
    Walls(const TriMesh& mesh, const SurfaceRays& rays, const Aabb& box)
        : most_(box.shortestEdge()), samples_(static_cast<std::size_t>(mesh.triangles.cols()))
    {
        const double below = 1e-5 * box.diagonal();
        forEach(samples_.size(), kShortWork, [&](std::size_t f) {
            const TriangleCorners corners = cornersOf(mesh, static_cast<Eigen::Index>(f));
            const Vec3 inward = -corners.normal();
            const Vec3 origin = corners.middle() + below * inward;
            const auto hit =
                rays.firstHit(origin, inward, box.diagonal(), SurfaceRays::Facing::along);
            samples_[f] =
                hit ? Sample{below + hit->distance, corners.areaVector().norm()} : Sample{};
        });
        for (const Sample& sample : samples_) totalArea_ += sample.area;
        std::sort(samples_.begin(), samples_.end(), [](const Sample& a, const Sample& b) {
            return a.thickness < b.thickness || (a.thickness == b.thickness && a.area < b.area);
        });
    }

    double atShare(double share) const
    {
        double seen = 0.0;
        for (const Sample& sample : samples_) {
            seen += sample.area;
            if (sample.area > 0.0 && seen >= share * totalArea_)
                return std::min(sample.thickness, most_);
        }
        return most_;
    }

private:
    struct Sample {
        double thickness = 0.0, area = 0.0;  // none where nothing is opposite
    };
    double most_, totalArea_ = 0.0;
    std::vector<Sample> samples_;
};

NodeLayout layOutNodes(const Aabb& box, double spacing)
{
    // Nodes lie on the low faces of the box, and on the high ones where the edge is a multiple of
    // h.
    NodeLayout nodes;
    nodes.spacing = spacing;
    nodes.origin = box.min - Vec3::Constant(kMarginCells * spacing);
    for (int k = 0; k < 3; ++k) {
        const double cells = std::ceil(box.size()[k] / spacing - 1e-9);
        nodes.count[k] = static_cast<int>(cells) + 1 + 2 * kMarginCells;
    }
    return nodes;
}

/// Node spacing from the settings, or from the thickness.  [A4]
double wantedSpacing(const ShapeSettings& settings, const Aabb& box, double thickness)
{
    const double longest = box.longestEdge();
    if (settings.voxel) return *settings.voxel;
    if (settings.resolution) return longest / *settings.resolution;
    return std::min(thickness / kVoxelsPerThickness, longest / kLeastResolution);
}

/// As wide as the lattice must be to have no more nodes than that, but no wider than the default is
/// for what is thick everywhere.
double coarsened(double spacing, const Aabb& box, std::size_t enoughNodes)
{
    constexpr double kCoarser = 1.02;
    const double longest = box.longestEdge(), widest = longest / kLeastResolution;
    spacing = std::max(spacing, longest / kMostResolution);
    while (spacing < widest && layOutNodes(box, spacing).nodeCount() > enoughNodes)
        spacing = std::min(kCoarser * spacing, widest);
    return spacing;
}

/// The same, coarser or refused where the field would be too large.  [A4]
double chooseSpacing(const std::string& name, const ShapeSettings& settings, const Aabb& box,
                     double thickness)
{
    const double longest = box.longestEdge();
    const double spacing = wantedSpacing(settings, box, thickness);
    if (settings.enoughNodes && !settings.resolution && !settings.voxel)
        return coarsened(spacing, box, *settings.enoughNodes);
    const double resolution = longest / spacing;
    char text[320];
    if (settings.voxel &&
        !(resolution > kLeastVoxels - 0.5 && resolution < kMostResolution + 0.5)) {
        std::snprintf(text, sizeof text,
                      "a voxel of %.4g m makes %.3g of them along its longest edge of "
                      "%.4g m; a field has %d to %d",
                      spacing, resolution, longest, kLeastVoxels, kMostResolution);
        throw Error(ErrorKind::badInput, "shape '" + name + "': " + text);
    }
    if (resolution > kMostResolution + 0.5) {
        std::snprintf(
            text, sizeof text,
            "its thinnest wall of %.4g m needs a field of %.0f voxels along "
            "its longest edge of %.4g m, more than the %d allowed; thicken the wall, split "
            "the shape, or set sdf = { resolution = %d } and accept a coarser field",
            thickness, std::round(resolution), longest, kMostResolution, kMostResolution);
        throw Error(ErrorKind::badInput, "shape '" + name + "': " + text);
    }
    return spacing;
}

/// The spacing of the lattice that a repair draws its surface on.
double repairVoxel(const TriMesh& mesh, const ShapeSettings& settings)
{
    const double longest = boxOf(mesh.points).longestEdge();
    double voxel = longest / settings.resolution.value_or(kRepairResolution);
    if (settings.voxel) voxel = *settings.voxel;
    if (settings.repair == MeshRepair::wrap) return voxel;
    return std::min(voxel, settings.repairThickness / kRepairVoxelsPerShell);
}

/// What a repair makes of a mesh, from the store if it is there.
TriMesh remeshed(const std::string& name, const TriMesh& mesh, const RemeshSettings& settings,
                 ShapeStore* store)
{
    const std::uint64_t key = solidKey(mesh, settings);
    if (store) {
        if (std::optional<TriMesh> kept = store->findSolid(key)) return std::move(*kept);
    }
    TriMesh solid = remeshSolid(mesh, settings, name);
    if (store) store->keepSolid(key, solid);
    return solid;
}

/// The solid that collides, in the artist's frame.
TriMesh makeSolid(const std::string& name, const TriMesh& assetMesh, const ShapeSettings& settings,
                  ShapeStore* store, ShapeRepairs& repairs)
{
    TriMesh solid = repairHarmlessly(assetMesh, repairs.harmless);
    if (settings.repair == MeshRepair::none) {
        requireSolid(solid, name);
        return solid;
    }
    requireSurface(solid, name);
    repairs.asked = settings.repair;
    if (settings.repair == MeshRepair::ground) {
        GroundSolid ground = closeBelow(solid, settings.repairThickness, name);
        repairs.groundUp = ground.up;
        repairs.behind = ground.depth;
        return std::move(ground.mesh);
    }
    if (settings.repair == MeshRepair::room) {
        // What looks inward has been turned as if it were to be full.
        if (std::exchange(repairs.harmless.isTurned, false)) turnInsideOut(solid);
        RoomSolid room = wallAround(solid, settings.repairThickness, name);
        repairs.behind = room.wall;
        return std::move(room.mesh);
    }
    if (settings.repair == MeshRepair::solidify) {
        repairs.behind = settings.repairThickness;
        return solidify(solid, settings.repairThickness, name);
    }
    repairs.voxel = repairVoxel(solid, settings);
    const RemeshSettings how{settings.repair, settings.repairThickness, repairs.voxel};
    TriMesh repaired = remeshed(name, solid, how, store);
    repairs.drawnToColliding = farthestApartInSight(solid, repaired);
    return repaired;
}

/// Whether a field that was kept can be one of this mesh on this lattice: nobody asks again before
/// a face is looked up.
bool fits(const DistanceField& kept, const TriMesh& mesh, const NodeLayout& layout)
{
    const NodeLayout& own = kept.nodes.layout;
    const auto faceCount = static_cast<std::uint32_t>(mesh.triangles.cols());
    return own.origin == layout.origin && own.spacing == layout.spacing &&
           own.count == layout.count &&
           std::ranges::all_of(kept.nearest.faces,
                               [&](const ListedFace& listed) { return listed.face < faceCount; });
}

/// The field of the shape's mesh, from the store if it is there.
DistanceField fieldOf(const Shape& shape, const NodeLayout& layout, const ShapeSettings& settings,
                      ShapeStore* store)
{
    const std::uint64_t key = fieldKey(shape.mesh, layout, settings.storage);
    if (store) {
        std::optional<DistanceField> kept = store->findField(key);
        if (kept && fits(*kept, shape.mesh, layout)) return std::move(*kept);
    }
    DistanceField field;
    field.nodes = buildDistanceNodes(shape.mesh, shape.rays, layout, settings.storage);
    field.nearest = findNearestFaces(shape.mesh, field.nodes);
    if (store) store->keepField(key, field);
    return field;
}

/// How far a point is from each axis.
Vec3 radiiAbout(const Vec3& point)
{
    const auto beside = [](double u, double v) { return std::sqrt(u * u + v * v); };
    return {beside(point.y(), point.z()), beside(point.z(), point.x()),
            beside(point.x(), point.y())};
}

/// What an exact solid but a sphere touches with. A cylinder may be drawn as a prism of a few
/// sides: it rolled like one, and of twelve sides lost two thirds of its speed in 2 s.
TriMesh meshThatTouches(const ExactSolid& solid, const TriMesh& drawn)
{
    constexpr int kSectors = 64;
    if (solid.form() == ExactSolid::Form::box || turnsThatShow(drawn).y() == 0.0) return drawn;
    return makeCylinder(solid.half().x(), 2.0 * solid.half().y(), kSectors, 1);
}

/// All that follows from the solid: mass, field, samples, rays, features.
void describeSolid(const std::string& name, const TriMesh& solid, const ShapeSettings& settings,
                   ShapeStore* store, Shape& shape)
{
    try {
        shape.unitMass = massProperties(solid);
    } catch (const Error& error) {
        throw Error(error.kind(), "shape '" + name + "': " + error.what());
    }

    shape.bodyFromAsset = inverse(Pose{shape.unitMass.centre, shape.unitMass.meshFromPrincipal});
    shape.mesh = transformed(solid, shape.bodyFromAsset);
    for (Eigen::Index v = 0; v < shape.mesh.points.cols(); ++v) {
        const Vec3 p = shape.mesh.points.col(v);
        shape.box.include(p);
        shape.boundingRadius = std::max(shape.boundingRadius, p.norm());
        shape.axisRadii = shape.axisRadii.cwiseMax(radiiAbout(p));
    }

    shape.rays = SurfaceRays(shape.mesh);
    const Walls walls(shape.mesh, shape.rays, shape.box);
    shape.innerThickness = walls.atShare(0.01);  // [A16]
    shape.commonThickness = walls.atShare(0.1);
    shape.usesTrueNormals =
        settings.normals == NormalMode::trueNormals ||
        (settings.normals == NormalMode::automatic && sharpestEdge(shape.mesh) > kSharpEdge);
    const bool withEdges =
        settings.edgeSamples.value_or(longestEdge(shape.mesh) > 0.5 * shape.innerThickness);
    shape.samples = makeSurfaceSamples(shape.mesh, withEdges);
    shape.features = ContactFeatures(shape.mesh);
    shape.hollows = HollowFacets(shape.mesh);
    if (!shape.usesTrueNormals) {
        shape.smooth = SmoothSurface(shape.mesh);
        shape.roundFacets = RoundFacets(shape.mesh);
        shape.capsule = capsuleOf(shape.mesh, shape.roundFacets);
    }
    shape.turnsThatShow = shape.isBall() ? Vec3(Vec3::Zero()) : turnsThatShow(shape.mesh);
    // What is round all over has no rims, though edges of its mesh lie around it.
    shape.rims = RoundRims(shape.features,
                           shape.roundFacets.areAll() ? Vec3(Vec3::Ones()) : shape.turnsThatShow);

    const double spacing = chooseSpacing(name, settings, shape.box, shape.innerThickness);
    shape.distance =
        SignedDistance(shape.mesh, fieldOf(shape, layOutNodes(shape.box, spacing), settings, store),
                       settings.field == FieldMode::refined);
    shape.innerBall = largestBallInside(shape.mesh, shape.distance, shape.innerThickness);
}

}  // namespace

std::shared_ptr<const Shape> buildMeshShape(const std::string& name, const TriMesh& assetMesh,
                                            const ShapeSettings& settings, ShapeStore* store)
{
    auto shape = std::make_shared<Shape>();
    shape->name = name;
    shape->assetMesh = assetMesh;
    const TriMesh solid = makeSolid(name, assetMesh, settings, store, shape->repairs);
    describeSolid(name, solid, settings, store, *shape);
    return shape;
}

std::shared_ptr<const Shape> buildMeshShape(const std::string& name, const TriMesh& drawn,
                                            const TriMesh& colliding, const ShapeSettings& settings,
                                            ShapeStore* store)
{
    requireSurface(drawn, name);
    auto shape = std::make_shared<Shape>();
    shape->name = name;
    shape->assetMesh = drawn;
    const TriMesh solid = makeSolid(name, colliding, settings, store, shape->repairs);
    shape->repairs.hasCollisionMesh = true;
    // Triangles without area are drawn for what they are worth, but have no closest point.
    const TriMesh drawnSurface = mergeEqualPoints(drawn);
    requireSurface(drawnSurface, name);
    shape->repairs.drawnToColliding = farthestApart(drawnSurface, solid);
    describeSolid(name, solid, settings, store, *shape);
    return shape;
}

std::shared_ptr<const Shape> buildExactShape(const std::string& name, const ExactSolid& solid,
                                             const TriMesh& mesh, const ShapeSettings& settings)
{
    auto shape = std::make_shared<Shape>();
    shape->name = name;
    shape->assetMesh = mesh;
    shape->mesh = mergeEqualPoints(mesh);
    requireSolid(shape->mesh, name);
    shape->unitMass = solid.massProperties();
    shape->box = solid.box();
    shape->boundingRadius = solid.boundingRadius();
    shape->axisRadii = radiiAbout(solid.half());
    const bool isRound = solid.form() != ExactSolid::Form::box;
    if (isRound) shape->axisRadii.y() = solid.half().x();
    shape->innerThickness = shape->commonThickness = shape->box.shortestEdge();
    // No field is sampled, so none can be too large: a playing card may be exact.
    shape->distance = SignedDistance(solid, wantedSpacing({}, shape->box, shape->innerThickness));
    shape->innerBall = {Vec3::Zero(), 0.5 * shape->innerThickness};
    shape->samplesMove = isRound;
    if (solid.form() == ExactSolid::Form::sphere) shape->capsule.radius = solid.half().x();
    if (shape->isBall()) {
        shape->turnsThatShow = Vec3::Zero();
    } else {
        if (isRound) shape->turnsThatShow.y() = 0.0;
        shape->features = ContactFeatures(meshThatTouches(solid, shape->mesh));
    }
    shape->rims = RoundRims(shape->features, shape->turnsThatShow);
    if (!shape->samplesMove) {
        const bool withEdges =
            settings.edgeSamples.value_or(longestEdge(shape->mesh) > 0.5 * shape->innerThickness);
        shape->samples = makeSurfaceSamples(shape->mesh, withEdges);
    }
    return shape;
}

std::shared_ptr<const Shape> buildPlaneShape(const std::string& name)
{
    auto shape = std::make_shared<Shape>();
    shape->name = name;
    shape->isPlane = true;
    shape->commonThickness = Shape::kEndless;
    shape->distance = SignedDistance(ExactSolid::plane());
    shape->box = Aabb::everything();
    return shape;
}

Aabb boxAt(const Shape& shape, const Pose& pose)
{
    if (shape.isPlane) return shape.box;
    const Mat3 rotation = pose.orientation.toRotationMatrix();
    Aabb box = transformed(shape.box, rotation, pose.position);
    const auto cut = [&](const Vec3& low, const Vec3& high) {
        box.min = box.min.cwiseMax(pose.position + low);
        box.max = box.max.cwiseMin(pose.position + high);
    };
    // The corners of the box of a ring are not of the ring: five in eight of the pairs of a
    // thousand rings met only there.
    const Vec3 ball = Vec3::Constant(shape.boundingRadius);
    cut(-ball, ball);
    for (int k = 0; k < 3; ++k) {
        const Vec3 axis = rotation.col(k);
        const Vec3 from = shape.box.min[k] * axis, to = shape.box.max[k] * axis;
        const Vec3 acrossAxis =
            (rotation.col((k + 1) % 3).cwiseAbs2() + rotation.col((k + 2) % 3).cwiseAbs2())
                .cwiseSqrt();
        const Vec3 beside = shape.axisRadii[k] * acrossAxis;
        cut(from.cwiseMin(to) - beside, from.cwiseMax(to) + beside);
    }
    return box;
}

Pose worldFromPlane(const Vec3& point, const Vec3& normal)
{
    // The shortest turn from +y to the normal; for opposite directions any half turn about x will
    // do.
    const Vec3 n = normal.normalized();
    const Vec3 halfway = Vec3::UnitY() + n;
    if (halfway.norm() < 1e-9) return {point, Quat(0.0, 1.0, 0.0, 0.0)};
    const Vec3 axis = Vec3::UnitY().cross(n);
    Quat q(1.0 + n.y(), axis.x(), axis.y(), axis.z());
    q.normalize();
    return {point, q};
}

}  // namespace scree
