// E21: the distance field against exact primitives, and its two storages against each other.
// [A4–A6, A10]  Shapes are built in code.
#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/geometry/primitives.h"
#include "core/geometry/shape.h"
#include "core/geometry/surface_normal.h"
#include "core/math/rotation.h"
#include "tools/verify/experiments.h"

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

void box(std::uint64_t points, Findings& findings)
{
    const Vec3 half(0.5, 0.35, 0.6);
    const auto shape = buildMeshShape("box", makeBox(2.0 * half, {1, 1, 1}));
    const double h = shape->distance.spacing();
    double nearby = 0.0, anywhere = 0.0, grid = 0.0, wrongSigns = 0.0;
    for (std::uint64_t i = 0; i < points; ++i) {
        const Vec3 p = drawIn(shape->box.grown(3.0 * h), i);
        const double exact = boxDistance(inverse(shape->bodyFromAsset) * p, half);
        const double phi = shape->distance.value(p), gridded = shape->distance.gridValue(p);
        const bool isNear = std::abs(gridded) < shape->distance.refinementBand();
        (isNear ? nearby : anywhere) = std::max(isNear ? nearby : anywhere, std::abs(phi - exact));
        if (isNear) grid = std::max(grid, std::abs(gridded - exact));
        wrongSigns += (phi < 0.0) != (exact < 0.0);
    }
    const std::string count = "box, " + std::to_string(points) + " points: ";
    findings.equal(must, count + "wrong signs", wrongSigns, 0);
    findings.atMost(must, count + "error near the surface", nearby, 1e-6, "m");
    findings.atMost(must, count + "error elsewhere", anywhere / h, 0.5, "voxels");
    findings.atLeast(control, count + "error near the surface, trilinear alone", grid / h, 0.1,
                     "voxels", "rounded edges: what the refinement is for");
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
        worst = std::max(worst, onSphere.cross(surfaceNormal(*shape, still)).norm());
    }
    findings.atMost(must, "sphere, 25 voxels to the radius: smooth normals are off",
                    worst * 180.0 / kPi, 1.0, "degrees");
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

void storages(std::uint64_t points, Findings& findings)
{
    ShapeSettings settings;
    settings.resolution = 96;
    const TriMesh ring = makeTorus(1.0, 0.25, {24, 16});
    settings.storage = FieldStorage::dense;
    const auto dense = buildMeshShape("ring", ring, settings);
    settings.storage = FieldStorage::bricks;
    const auto bricks = buildMeshShape("ring", ring, settings);
    double signs = 0.0, difference = 0.0;
    for (std::uint64_t i = 0; i < points; ++i) {
        const Vec3 p = drawIn(dense->box.grown(0.1), i);
        const double a = dense->distance.value(p), b = bricks->distance.value(p);
        signs += (a < 0.0) != (b < 0.0);
        const bool isNear =
            std::abs(dense->distance.gridValue(p)) < dense->distance.refinementBand();
        if (isNear) difference = std::max(difference, std::abs(a - b));
    }
    findings.equal(must, "ring, dense against bricks: points of unlike sign", signs, 0);
    findings.atMost(must, "ring, dense against bricks: difference in the band", difference, 1e-6,
                    "m");
}

}  // namespace

void runDistanceField(const Context& context, Findings& findings)
{
    const std::uint64_t points = context.isFull() ? 1000000 : 50000;
    box(points, findings);
    sphere(points, findings);
    cubeNormals(points, findings);
    storages(points, findings);
}

}  // namespace scree::verify
