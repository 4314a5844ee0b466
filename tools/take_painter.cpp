#include "tools/take_painter.h"

#include <map>

#include "core/base/error.h"
#include "core/math/aabb.h"
#include "render/text.h"
#include "tools/command_line.h"

namespace scree {
namespace {

/// Frames that are looked at to find a view of everything: more would cost and show no more.
constexpr int kViewFrames = 12;

std::vector<Look> looksOf(const TakeInfo& info, const SceneDescription& scene)
{
    std::map<std::string, Look> byMaterial;
    for (const TakeLook& look : info.looks)
        byMaterial[look.material] = {look.color, look.roughness};
    std::vector<Look> looks;
    for (const SceneBody& body : scene.bodies) looks.push_back(byMaterial[body.material]);
    return variedLooks(scene, looks);
}

/// Around everything that movable bodies do, or around all bodies when none moves; planes not at
/// all.
Aabb actionBox(const TakeReader& take, const SceneDescription& scene,
               const std::vector<int>& frames)
{
    std::vector<Aabb> meshBoxes(scene.meshes.size());
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh)
        for (Eigen::Index i = 0; i < scene.meshes[mesh].points.cols(); ++i)
            meshBoxes[mesh].include(Vec3(scene.meshes[mesh].points.col(i)));

    Aabb moving, all;
    for (const int number : spreadFrames(frames, kViewFrames)) {
        const SceneFrame frame = take.readFrame(number);
        for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
            if (take.info().bodies[body].isPlane) continue;
            if (!isThere(scene.bodies[body], number)) continue;
            const Pose& pose = frame.worldFromAsset[body];
            const Aabb box = transformed(meshBoxes[scene.bodies[body].mesh],
                                         pose.orientation.toRotationMatrix(), pose.position);
            all.include(box);
            if (scene.bodies[body].moves) moving.include(box);
        }
    }
    if (!moving.isEmpty()) return moving;
    return all.isEmpty() ? Aabb{-Vec3::Ones(), Vec3::Ones()} : all;
}

Camera chooseCamera(const TakeReader& take, const SceneDescription& scene,
                    const std::vector<int>& frames, const std::string& name, double aspect)
{
    const Vec3 up = scene.zUp ? Vec3::UnitZ() : Vec3::UnitY();
    std::string known;
    for (const TakeCamera& camera : take.info().cameras) {
        if (name.empty() || camera.name == name)
            return {camera.eye, camera.target, up, camera.fovDegrees};
        known += (known.empty() ? "" : ", ") + camera.name;
    }
    if (!name.empty())
        throw Error(ErrorKind::usage, "the shot has no camera \"" + name + "\"" +
                                          (known.empty() ? "" : "; it has " + known));
    return frameAll(actionBox(take, scene, frames), threeQuarterView(scene.zUp), up, aspect);
}

}  // namespace

TakePainter::TakePainter(const TakeReader& take, const std::vector<int>& frames,
                         const std::string& cameraName, const std::array<int, 2>& size)
    : take_(take), scene_(take.describe()), size_(size)
{
    const double aspect = static_cast<double>(size[0]) / size[1];
    camera_ = chooseCamera(take, scene_, frames, cameraName, aspect);
    rasterizer_ = std::make_unique<Rasterizer>(scene_, looksOf(take.info(), scene_));
}

Image TakePainter::paint(int frame, const std::string& burnedIn)
{
    Image image = rasterizer_->draw(take_.readFrame(frame), camera_, size_[0], size_[1]);
    if (!burnedIn.empty()) burnIn(image, burnedIn);
    return image;
}

}  // namespace scree
