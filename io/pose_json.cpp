#include "io/pose_json.h"

#include <nlohmann/json.hpp>

namespace scree {

std::string encodePoses(const SceneDescription& scene, const SceneFrame& frame)
{
    nlohmann::ordered_json bodies = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const Pose& pose = frame.worldFromAsset[i];
        const Vec3& p = pose.position;
        const Quat& q = pose.orientation;
        bodies.push_back({{"name", scene.bodies[i].name},
                          {"mesh", scene.meshes[scene.bodies[i].mesh].name},
                          {"position", {p.x(), p.y(), p.z()}},
                          {"orientation", {q.w(), q.x(), q.y(), q.z()}}});
    }
    const nlohmann::ordered_json json = {{"scene", scene.name},
                                         {"metres_per_unit", scene.metresPerUnit},
                                         {"up", scene.zUp ? "+z" : "+y"},
                                         {"frame", frame.frame},
                                         {"bodies", bodies}};
    return json.dump(1) + "\n";
}

}  // namespace scree
