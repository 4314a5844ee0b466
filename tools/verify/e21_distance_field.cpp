// E21: the distance field against exact primitives, and its two storages against each other.
// [A4–A6, A10, A11, A13]  Shapes are built in code.
#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/collision/interference.h"
#include "core/geometry/primitives.h"
#include "core/geometry/shape.h"
#include "core/geometry/surface_normal.h"
#include "core/math/rotation.h"
#include "tools/verify/experiments.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

Vec3 drawIn(const Aabb& box, std::uint64_t i)
{
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
        p[k] = box.min[k] + box.size()[k] * randomUnit(21, i, static_cast<std::uint64_t>(k));
    }
    return p;
}

double boxDistance(const Vec3& p, const Vec3& half)
{
    const Vec3 d = p.cwiseAbs() - half;
    return d.cwiseMax(0.0).norm() + std::min(d.maxCoeff(), 0.0);
}

/// Distance along the surface to the nearest edge, of a point near a face: that to the plane of the
/// second nearest face.
double secondFace(const Vec3& p, const Vec3& half)
{
    Vec3 d = (p.cwiseAbs() - half).cwiseAbs();
    std::sort(d.begin(), d.end());
    return d[1];
}

void box(std::uint64_t points, Findings& findings)
{
    const Vec3 half(0.5, 0.35, 0.6);
    const auto shape = buildMeshShape("box", makeBox(2.0 * half, {1, 1, 1}));
    const double h = shape->distance.spacing();
    double nearby = 0.0, anywhere = 0.0, grid = 0.0, faces = 0.0, wrongSigns = 0.0;
    for (std::uint64_t i = 0; i < points; ++i) {
        const Vec3 p = drawIn(shape->box.grown(3.0 * h), i);
        const Vec3 asset = inverse(shape->bodyFromAsset) * p;
        const double exact = boxDistance(asset, half);
        const double phi = shape->distance.value(p), gridded = shape->distance.gridValue(p);
        const bool isNear = std::abs(gridded) < shape->distance.refinementBand();
        (isNear ? nearby : anywhere) = larger(isNear ? nearby : anywhere, std::abs(phi - exact));
        if (isNear) grid = larger(grid, std::abs(gridded - exact));
        if (isNear && secondFace(asset, half) > 2.0 * h) {
            faces = larger(faces, std::abs(gridded - exact));
        }
        wrongSigns += (phi < 0.0) != (exact < 0.0);
    }
    const std::string count = "box, " + std::to_string(points) + " points: ";
    findings.equal(must, count + "wrong signs", wrongSigns, 0);
    findings.atMost(must, count + "error near the surface", nearby, 1e-6, "m");
    findings.atMost(must, count + "error elsewhere", anywhere / h, 0.5, "voxels");
    findings.atMost(must, count + "error 2 voxels from all edges, trilinear alone", faces, 1e-6,
                    "m");
    findings.atMost(must, count + "error near the surface, trilinear alone", grid / h, 0.5,
                    "voxels");
    findings.atLeast(control, count + "the same: edges are rounded, for which refinement is",
                     grid / h, 0.1, "voxels");
}

void sphere(std::uint64_t points, Findings& findings)
{
    ShapeSettings settings;
    settings.resolution = 50;  // h = R/25
    const auto shape = buildMeshShape("sphere", makeSphere(1.0, 4), settings);
    double worst = 0.0;
    for (std::uint64_t i = 0; i < points / 10; ++i) {
        const Vec3 p = drawIn(shape->box, i);
        if (p.norm() < 0.1) continue;
        const Vec3 onSphere = p.normalized();
        const Approach still{onSphere, Vec3::Zero(), onSphere, onSphere};
        worst = larger(worst, onSphere.cross(surfaceNormal(*shape, still)).norm());
    }
    findings.atMost(must, "sphere, 25 voxels to the radius: smooth normals are off",
                    worst * 180.0 / kPi, 1.0, "degrees");

    // So many triangles that the mesh is nearer to the sphere than the grid may be.
    settings.resolution = 30;
    const auto round = buildMeshShape("sphere", makeSphere(1.0, 6), settings);
    const double h = round->distance.spacing();
    double error = 0.0;
    for (std::uint64_t i = 0; i < points / 10; ++i) {
        const Vec3 p =
            drawIn(round->box, i).normalized() * (1.0 + h * (2.0 * randomUnit(24, i) - 1.0));
        error = larger(error, std::abs(round->distance.gridValue(p) - (p.norm() - 1.0)));
    }
    findings.atMost(must, "sphere, a voxel about its surface: error, trilinear alone",
                    error / (h * h), 0.3, "h^2/R");
}

void cubeNormals(std::uint64_t points, Findings& findings)
{
    const auto shape = buildMeshShape("cube", makeBox(Vec3::Ones(), {1, 1, 1}));
    double wrong = 0.0;
    for (std::uint64_t i = 0; i < points / 10; ++i) {
        const int axis = static_cast<int>(randomIndex(3, 22, i));
        const double side = randomUnit(23, i) < 0.5 ? -1.0 : 1.0;
        Vec3 p = drawIn(shape->box, i), n = Vec3::Zero();
        n[axis] = side;
        p[axis] = 0.5 * side;
        const Approach still{p, Vec3::Zero(), p, p};
        wrong += surfaceNormal(*shape, still).dot(n) < 1.0 - 1e-9;
    }
    findings.atMost(must, "cube: true normals that are not the face's",
                    wrong / (static_cast<double>(points) / 10.0), 1e-3, "of points on the surface");
}

std::shared_ptr<const Shape> stored(const TriMesh& mesh, FieldStorage storage)
{
    ShapeSettings settings;
    settings.resolution = 96;
    settings.storage = storage;
    return buildMeshShape("shape", mesh, settings);
}

/// [A10]  A ring has much empty space to leave out, a block much inside.
void storages(std::uint64_t points, Findings& findings)
{
    const std::pair<const char*, TriMesh> meshes[] = {
        {"ring", makeTorus(1.0, 0.25, {24, 16})}, {"block", makeBox({1.0, 0.9, 1.1}, {2, 2, 2})}};
    for (const auto& [name, mesh] : meshes) {
        const auto dense = stored(mesh, FieldStorage::dense);
        const auto bricks = stored(mesh, FieldStorage::bricks);
        double signs = 0.0, difference = 0.0, ofGrids = 0.0;
        for (std::uint64_t i = 0; i < points; ++i) {
            const Vec3 p = drawIn(dense->box.grown(0.1), i);
            const double a = dense->distance.value(p), b = bricks->distance.value(p);
            signs += (a < 0.0) != (b < 0.0);
            const bool isNear =
                std::abs(dense->distance.gridValue(p)) < dense->distance.refinementBand();
            if (!isNear) continue;
            difference = larger(difference, std::abs(a - b));
            ofGrids = larger(
                ofGrids, std::abs(dense->distance.gridValue(p) - bricks->distance.gridValue(p)));
        }
        const std::string which = std::string(name) + ", dense against bricks: ";
        findings.equal(must, which + "points of unlike sign", signs, 0);
        findings.atMost(must, which + "difference in the band", difference, 1e-6, "m");
        findings.atMost(must, which + "difference in the band, trilinear alone", ofGrids, 1e-6,
                        "m");
    }
}

bool isSameList(std::vector<Touch> a, std::vector<Touch> b)
{
    std::sort(a.begin(), a.end(), isDeeper);
    std::sort(b.begin(), b.end(), isDeeper);
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Touch& s, const Touch& t) {
        return s.phi == t.phi && s.sample == t.sample && s.sampleOnA == t.sampleOnA;
    });
}

/// [A10, A11, A13]  Block labels, least and greatest values and clusters of samples only save work:
/// the plain search asks every sample of both shapes and no block.
void sampleLists(std::uint64_t pairs, Findings& findings)
{
    std::vector<std::shared_ptr<const Shape>> shapes;
    for (const TriMesh& mesh : {makeTorus(1.0, 0.25, {16, 10}), makeBox({1.0, 0.4, 1.1}, {1, 1, 1}),
                                makeSphere(0.6, 2)}) {
        shapes.push_back(stored(mesh, FieldStorage::dense));
        shapes.push_back(stored(mesh, FieldStorage::bricks));
    }
    const Aabb turns{Vec3::Constant(-2.0), Vec3::Constant(2.0)};
    const Aabb places{Vec3::Constant(-1.0), Vec3::Constant(1.0)};
    int touching = 0, unlike = 0;
    for (std::uint64_t i = 0; i < pairs; ++i) {
        const Shape& a = *shapes[randomIndex(shapes.size(), 35, i)];
        const Shape& b = *shapes[randomIndex(shapes.size(), 36, i)];
        const PlacedPair pair{&a, &b,
                              Pose{drawIn(places, 3 * i), exponentialMap(drawIn(turns, 3 * i + 1))},
                              Pose{Vec3::Zero(), exponentialMap(drawIn(turns, 3 * i + 2))}};
        std::vector<Touch> fast, plain;
        Proximity proximity;
        proximity.setMargin(0.01);
        proximity.findTouches(pair, contourValue(a, b), fast);
        findTouchesPlainly(pair, contourValue(a, b), plain);
        touching += !plain.empty();
        unlike += !isSameList(fast, plain);
    }
    const std::string name = std::to_string(pairs) + " random pairs: ";
    findings.equal(must, name + "sample lists that blocks and clusters change", unlike, 0);
    findings.atLeast(control, name + "that touch at all", touching,
                     0.1 * static_cast<double>(pairs), "");
}

/// [A15]  Of method paper, which alone asks again and again: pairs that were found free are passed
/// over until one of their bodies has moved.
void skipStamps(const Context& context, Findings& findings)
{
    if (context.method != "paper") return;
    const std::vector<std::string> nine = {
        "emitter.drop.count=9", "emitter.drop.layout.grid.count=[3, 1, 3]",
        setVector("emitter.drop.layout.position", {0.0, 0.9, 0.0})};
    ShotRun with(context, "E22_drop", nine);
    ShotRun without(context, "E22_drop", nine,
                    [](StepSettings& settings) { settings.skipStamps = false; });
    int unlike = 0, pairs = 0;
    for (int frame = 0; frame < 16; ++frame) {
        std::uint64_t hash = 0;
        with.advanceFrames(1, [&](const FrameReport& report) {
            hash = report.stateHash;
            pairs += static_cast<int>(report.sum.contactPairs);
        });
        without.advanceFrames(
            1, [&](const FrameReport& report) { unlike += report.stateHash != hash; });
    }
    findings.equal(must, "nine boxes dropped, 16 frames: those that skip stamps change", unlike, 0);
    findings.atLeast(control, "nine boxes dropped: pairs in contact", pairs, 10.0, "");
}

}  // namespace

void runDistanceField(const Context& context, Findings& findings)
{
    const std::uint64_t points = context.isFull() ? 1000000 : 50000;
    box(points, findings);
    sphere(points, findings);
    cubeNormals(points, findings);
    storages(points, findings);
    sampleLists(context.isFull() ? 10000 : 2000, findings);
    skipStamps(context, findings);
}

}  // namespace scree::verify
