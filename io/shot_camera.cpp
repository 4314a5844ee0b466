#include "io/shot_camera.h"

#include "core/picture/camera_motion.h"
#include "io/emitter.h"
#include "io/shot_import.h"
#include "io/shot_values.h"

namespace scree {
namespace {

class CameraInterpreter {
public:
    CameraInterpreter(const Shot& shot, ProblemList& problems) : shot_(shot), problems_(problems) {}

    SceneCamera interpret(const ShotNode& node)
    {
        camera_.name = node.find("name")->text;
        camera_.target = placeIn(*node.find("target"));
        camera_.fovDegrees = node.find("fov")->number;
        camera_.isSmooth = node.find("interpolate")->text == "smooth";
        if (const ShotNode* eye = node.find("eye")) {
            camera_.eye = placeIn(*eye);
            refuseBlind(camera_.eye, camera_.target, *eye);
        }
        if (const ShotNode* keys = node.find("keys")) readKeys(*keys);
        if (const ShotNode* orbit = node.find("orbit")) readOrbit(*orbit);
        if (!mentionsAny(node, {"eye", "keys", "orbit", "file"}))
            problems_.add(node.where,
                          "camera '" + camera_.name +
                              "' needs 'eye', 'keys', 'orbit' or 'file' to stand somewhere");
        const SceneCamera begin = cameraAt(camera_, shot_.firstFrame, shot_.zUp);
        camera_.eye = begin.eye;
        camera_.target = begin.target;
        camera_.fovDegrees = begin.fovDegrees;
        return camera_;
    }

private:
    Vec3 placeIn(const ShotNode& node) const
    {
        return shot_.metresPerUnit *
               Vec3(node.items[0].number, node.items[1].number, node.items[2].number);
    }

    void refuseBlind(const Vec3& eye, const Vec3& target, const ShotNode& where)
    {
        if (eye == target) problems_.add(where.where, "'eye' must not be where 'target' is");
    }

    /// Target and angle of view are the camera's own where a key does not say otherwise.
    void readKeys(const ShotNode& list)
    {
        if (list.items.empty()) problems_.add(list.where, "'keys' must hold at least one key");
        for (const ShotNode& node : list.items) {
            const ShotNode *frame = node.find("frame"), *eye = node.find("eye");
            if (!frame || !eye) continue;
            CameraKey key{frame->number, placeIn(*eye), camera_.target, camera_.fovDegrees};
            if (const ShotNode* target = node.find("target")) key.target = placeIn(*target);
            if (const ShotNode* fov = node.find("fov")) key.fovDegrees = fov->number;
            refuseBlind(key.eye, key.target, *eye);
            if (!camera_.keys.empty() && key.frame <= camera_.keys.back().frame) {
                problems_.add(frame->where, "the frames of 'keys' must ascend, but " +
                                                toTomlText(key.frame) + " comes after " +
                                                toTomlText(camera_.keys.back().frame));
                continue;
            }
            camera_.keys.push_back(key);
        }
    }

    void readOrbit(const ShotNode& node)
    {
        const ShotNode *centre = node.find("centre"), *radius = node.find("radius"),
                       *height = node.find("height"), *start = node.find("start"),
                       *degrees = node.find("degrees"), *frames = node.find("frames");
        if (!radius || !height || !start || !degrees) return;  // reported as wrong
        CameraOrbit orbit;
        orbit.centre = centre ? placeIn(*centre) : camera_.target;
        orbit.radius = radius->number * shot_.metresPerUnit;
        orbit.height = height->number * shot_.metresPerUnit;
        orbit.startDegrees = start->number;
        orbit.degrees = degrees->number;
        int first = shot_.firstFrame, last = shot_.lastFrame;
        if (frames && (!readFrameRange(frames->text, first, last) || last < first))
            problems_.add(frames->where,
                          "'frames' must be \"FIRST-LAST\", for example \"1001-1240\", not " +
                              toTomlText(*frames));
        orbit.firstFrame = first;
        orbit.lastFrame = last;
        camera_.orbit = orbit;
    }

    const Shot& shot_;
    ProblemList& problems_;
    SceneCamera camera_;
};

}  // namespace

SceneCamera interpretCamera(const ShotNode& node, const std::filesystem::path& folder,
                            const Shot& shot, ProblemList& problems)
{
    if (const ShotNode* file = node.find("file")) {
        const std::string path = (folder / file->text).lexically_normal().string();
        SceneCamera camera = readImportedCamera(node, path, shot, problems).value_or(SceneCamera());
        camera.name = node.find("name")->text;
        return camera;
    }
    if (const ShotNode* nodeOfFile = node.find("node")) {
        problems.add(nodeOfFile->where, "'node' chooses a camera of a 'file', and there is none");
    }
    for (const char* key : {"position", "rotation", "orientation", "scale"}) {
        const ShotNode* placement = node.find(key);
        if (!placement || node.mentions("eye")) continue;
        problems.add(placement->where, "'" + std::string(key) +
                                           "' places the camera of a 'file', and there is none; "
                                           "where a camera stands is its 'eye'");
        return SceneCamera();
    }
    return CameraInterpreter(shot, problems).interpret(node);
}

}  // namespace scree
