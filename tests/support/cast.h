// A small cast for the tests of exporters that hold looks: one of everything that can go wrong.
#pragma once

#include <string>
#include <vector>

#include "tests/support/export_scene.h"

namespace scree::test {

/// Two shapes (one with texture coordinates), three materials, a camera; bodies that tumble, one
/// that could move but rests, one that cannot, one of an unknown material, and one whose name
/// begins with a digit.
inline SceneDescription castScene()
{
    SceneDescription scene =
        sceneOf({bodyNamed("tumbler", true, 0), bodyNamed("sleeper", true, 1),
                 bodyNamed("floor", false, 1), bodyNamed("9lives", true, 1),
                 bodyNamed("stranger", true, 0), bodyNamed("_9lives", true, 0)});
    scene.meshes[0] = texturedTetrahedron("tetrahedron");
    scene.bodies[2].material = "2k_rubber";
    scene.bodies[3].material = "wood";
    scene.bodies[4].material = "unknown";
    SceneMesh tile;
    tile.name = "2 tiles \"a\"";
    tile.points.resize(3, 4);
    tile.points << -1, -1, 1, 1,  //
        0, 0, 0, 0,               //
        -1, 1, 1, -1;
    tile.triangles.resize(3, 2);
    tile.triangles << 0, 0,  //
        1, 2,                //
        2, 3;
    scene.meshes.push_back(tile);
    scene.materials = {{"steel", {0.5, 0.55, 0.6}, 0.25, 7800.0, 0.4, 0.3},
                       {"2k_rubber", {0.8, 0.05, 0.04}, 0.9, 1100.0, 0.9, 0.6},
                       {"wood", {0.4, 0.25, 0.1}, 0.7, 600.0, 0.5, 0.2}};
    scene.cameras = {{"main", {3.0, 4.0, 12.0}, {0.5, 2.0, -1.0}, 40.0}};
    return scene;
}

constexpr double kSpin = 2.0;  ///< of all bodies that move [rad/s]

/// Where a body of the cast is at `time` [frames]: flying straight and spinning steadily, so that
/// positions interpolated linearly, rotations along the arc and both extrapolated by velocities are
/// all the motion itself.
inline Pose castPose(const SceneDescription& scene, std::size_t body, double time)
{
    const double b = static_cast<double>(body);
    const double seconds = (time - 1001.0) / scene.framesPerSecond;
    const bool rests = !scene.bodies[body].moves || scene.bodies[body].name == "sleeper";
    const Vec3 velocity = rests ? Vec3(Vec3::Zero()) : Vec3(1.0 + b, -9.0 / 7.0, 0.3 * b);
    const Vec3 axis = Vec3(1.0 + b, 2.0, 3.0 - b).normalized();
    const Quat turned(Eigen::AngleAxisd((rests ? 0.0 : kSpin) * seconds, axis));
    const Quat start(Eigen::AngleAxisd(0.7 + b, Vec3(2.0, 1.0 / 3.0, -b).normalized()));
    return {Vec3(b / 3.0, 5.0 - b, -b) + seconds * velocity, turned * start};
}

inline SceneFrame castFrame(const SceneDescription& scene, int number, double offset = 0.0)
{
    SceneFrame frame;
    frame.frame = number;
    frame.offset = offset;
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        // Velocities as differences of poses: a second, independent way to say what moves.
        const double h = 1e-3;
        const Pose now = castPose(scene, body, number + offset);
        const Pose later = castPose(scene, body, number + offset + h);
        const Eigen::AngleAxisd turn(later.orientation * now.orientation.conjugate());
        const double seconds = h / scene.framesPerSecond;
        frame.worldFromAsset.push_back(now);
        frame.velocity.push_back((later.position - now.position) / seconds);
        frame.angularVelocity.push_back(turn.angle() / seconds * turn.axis());
    }
    return frame;
}

inline constexpr int kCastFirst = 1001, kCastFrames = 5;

template <class Writer>
void exportCast(Writer& writer, const SceneDescription& scene,
                const std::vector<double>& offsets = {0.0})
{
    writer.begin(scene, kCastFirst, kCastFrames, offsets);
    for (int frame = kCastFirst; frame < kCastFirst + kCastFrames; ++frame) {
        for (const double offset : offsets) writer.write(castFrame(scene, frame, offset));
    }
    writer.finish();
}

}  // namespace scree::test
