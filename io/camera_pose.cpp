#include "io/camera_pose.h"

#include <algorithm>
#include <cmath>

#include "core/math/point_box.h"
#include "core/math/rotation.h"
#include "core/picture/camera_motion.h"

namespace scree {

Pose worldFromCamera(const SceneCamera& camera, bool zUp)
{
    const Mat3 axes = worldFromViewAxes(camera.eye, camera.target, upOf(camera, zUp));
    return {camera.eye, Quat(axes).normalized()};
}

std::vector<SceneCamera> camerasAt(const SceneCamera& camera, const std::vector<double>& times,
                                   bool zUp)
{
    std::vector<SceneCamera> cameras;
    for (const double time : times) cameras.push_back(cameraAt(camera, time, zUp));
    return cameras;
}

std::vector<Pose> worldFromCameras(const std::vector<SceneCamera>& cameras, bool zUp)
{
    std::vector<Pose> poses;
    for (const SceneCamera& camera : cameras) {
        Pose pose = worldFromCamera(camera, zUp);
        if (!poses.empty() && pose.orientation.dot(poses.back().orientation) < 0.0)
            pose.orientation.coeffs() *= -1.0;
        poses.push_back(pose);
    }
    return poses;
}

SceneCamera cameraOfAll(const SceneDescription& scene, const SceneFrame& frame)
{
    Aabb moving, all;
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        const Aabb meshBox = boxOf(scene.meshes[scene.bodies[body].mesh].points);
        if (meshBox.isEmpty()) continue;
        const Pose& pose = frame.worldFromAsset[body];
        const Aabb box = transformed(meshBox, pose.orientation.toRotationMatrix(), pose.position);
        all.include(box);
        if (scene.bodies[body].moves) moving.include(box);
    }
    Aabb box = moving.isEmpty() ? all : moving;
    if (box.isEmpty()) box = {-Vec3::Ones(), Vec3::Ones()};

    // Stand back until the ball around the box is inside the narrower of the two fields of view.
    SceneCamera camera;
    camera.name = "view";
    camera.target = box.centre();
    const double tanVertical = std::tan(camera.fovDegrees * kPi / 360.0);
    const double half = std::atan(tanVertical * std::min(1.0, scene.aspect));
    const double radius = std::max(0.5 * box.diagonal(), 1e-6);
    const Vec3 towardEye = scene.zUp ? Vec3(0.58, -0.70, 0.42) : Vec3(0.58, 0.42, 0.70);
    camera.eye = camera.target + radius / std::sin(half) * towardEye.normalized();
    return camera;
}

}  // namespace scree
