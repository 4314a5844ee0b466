// A heap to look at, without a simulation: rings strewn over a mound on the ground, and poles. Only
// pictures and their benchmarks use it; rings may overlap.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "core/picture/scene_description.h"
#include "render/camera.h"
#include "render/look.h"

namespace scree::test {

struct PreviewScene {
    SceneDescription scene;
    std::vector<Look> looks;
    SceneFrame frame;
    Camera camera;

    void add(std::size_t mesh, const Pose& pose, const Look& look, bool moves)
    {
        scene.bodies.push_back({"body_" + std::to_string(scene.bodies.size()), mesh, "stuff",
                                moves ? 1.0 : 0.0, moves});
        looks.push_back(look);
        frame.worldFromAsset.push_back(pose);
    }
};

/// A turn drawn for `item`, all directions alike.
inline Quat strewnTurn(std::uint64_t item)
{
    const Vec3 axis(randomUnit(3, item, 0) - 0.5, randomUnit(3, item, 1) - 0.5,
                    randomUnit(3, item, 2) - 0.5);
    return Quat(Eigen::AngleAxisd(2.0 * kPi * randomUnit(3, item, 3), axis.normalized()));
}

/// `count` copies of a mesh whose ball has the radius `size`, on a mound as wide as they need.
inline PreviewScene strewnHeap(const TriMesh& mesh, double size, int count)
{
    PreviewScene heap;
    SceneMesh square{"ground", Points(3, 4), Triangles(3, 2)};
    square.isPlane = true;
    square.points << -5, -5, 5, 5, 0, 0, 0, 0, -5, 5, 5, -5;
    square.triangles << 0, 0, 1, 2, 2, 3;
    const double reach = 0.85 * size * std::cbrt(count), height = 0.5 * reach;
    const TriMesh pole = makeCylinder(0.25 * size, 0.9 * reach, 20, 21);
    heap.scene.meshes = {
        square, {"strewn", mesh.points, mesh.triangles}, {"pole", pole.points, pole.triangles}};
    heap.add(0, {}, {Vec3::Constant(0.4), 0.9}, false);
    const int row = count < 500 ? 2 : 5;
    for (int i = 0; i < row * row; ++i) {
        const Vec3 steps(i % row - 0.5 * (row - 1), 0.0, i / row - 0.5 * (row - 1));
        const Vec3 place = 1.6 * reach / (row - 1) * steps + 0.45 * reach * Vec3::UnitY();
        heap.add(2, {place, Quat::Identity()}, {{0.35, 0.40, 0.48}, 0.6}, false);
    }
    for (int i = 0; i < count; ++i) {
        const double share = std::sqrt(randomUnit(1, i)), angle = 2.0 * kPi * randomUnit(2, i);
        const double x = reach * share * std::cos(angle), z = reach * share * std::sin(angle);
        const double y = 0.3 * size + height * (1.0 - share) * randomUnit(4, i);
        heap.add(1, {Vec3(x, y, z), strewnTurn(i)}, {{0.72, 0.53, 0.30}, 0.4}, true);
    }
    heap.looks = variedLooks(heap.scene, heap.looks);
    heap.camera.target = 0.45 * reach * Vec3::UnitY();
    heap.camera.eye =
        heap.camera.target + 4.511572592172724 * reach * threeQuarterView(false).normalized();
    return heap;
}

inline PreviewScene heapOfRings(int count)
{
    return strewnHeap(makeTorus(1.0, 0.25, {16, 10}), 1.25, count);
}

}  // namespace scree::test
