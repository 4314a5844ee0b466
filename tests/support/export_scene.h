// A small scene for the tests of exporters: a tetrahedron, and bodies that tumble or never move.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/picture/scene_description.h"

namespace scree::test {

/// A closed tetrahedron off the origin, so that no axis looks like another; outward faces.
inline SceneMesh tetrahedron(const std::string& name = "tetrahedron")
{
    SceneMesh mesh;
    mesh.name = name;
    mesh.points.resize(3, 4);
    mesh.points << 0.1, 1.3, 0.2, 0.3,  //
        0.2, 0.1, 1.4, 0.1,             //
        0.3, 0.2, 0.1, 1.7;
    mesh.triangles.resize(3, 4);
    mesh.triangles << 0, 0, 0, 1,  //
        2, 1, 3, 2,                //
        1, 3, 2, 3;
    return mesh;
}

/// The same with texture coordinates, of which no two corners have the same: every edge is a seam.
/// Sixteenths, which every format holds without rounding.
inline SceneMesh texturedTetrahedron(const std::string& name = "textured")
{
    SceneMesh mesh = tetrahedron(name);
    mesh.cornerUvs.resize(2, mesh.triangles.size());
    for (Eigen::Index corner = 0; corner < mesh.cornerUvs.cols(); ++corner) {
        const auto number = static_cast<float>(corner);
        mesh.cornerUvs.col(corner) << number / 16.0f, (number - 3.0f) / 8.0f;
    }
    return mesh;
}

inline SceneBody bodyNamed(const std::string& name, bool moves = true, std::size_t mesh = 0)
{
    SceneBody body;
    body.name = name;
    body.mesh = mesh;
    body.material = "steel";
    body.mass = moves ? 2.5 : 0.0;
    body.moves = moves;
    return body;
}

inline SceneDescription sceneOf(std::vector<SceneBody> bodies)
{
    SceneDescription scene;
    scene.name = "test_shot";
    scene.meshes = {tetrahedron()};
    scene.bodies = std::move(bodies);
    return scene;
}

/// A pose that no other (body, step) shares; numbers with long fractions, so that rounding would
/// show.
inline Pose tumblingPose(std::size_t body, double step)
{
    const double b = static_cast<double>(body);
    const Vec3 axis = Vec3(1.0 + b, 2.0, 3.0 - b).normalized();
    return {Vec3(b / 3.0 + step / 7.0, 10.0 - step * step / 11.0, -b + std::sqrt(step)),
            Quat(Eigen::AngleAxisd(0.3 * step + 0.1 * b, axis))};
}

inline SceneFrame frameWith(int number, std::vector<Pose> poses)
{
    SceneFrame frame;
    frame.frame = number;
    frame.velocity.assign(poses.size(), Vec3::Zero());
    frame.angularVelocity.assign(poses.size(), Vec3::Zero());
    frame.worldFromAsset = std::move(poses);
    return frame;
}

/// All bodies tumble.
inline SceneFrame tumblingFrame(const SceneDescription& scene, int number, int firstFrame)
{
    std::vector<Pose> poses;
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        poses.push_back(tumblingPose(body, number - firstFrame));
    }
    return frameWith(number, std::move(poses));
}

}  // namespace scree::test
