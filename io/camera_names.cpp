#include "io/camera_names.h"

#include "io/unique_names.h"

namespace scree {

std::vector<std::string> cameraNames(const SceneDescription& scene)
{
    UniqueNames siblings;
    for (const SceneBody& body : scene.bodies) siblings.take(body.name);
    for (const char* group : {"Prototypes", "Materials", "Bodies"}) siblings.take(group);
    std::vector<std::string> names;
    for (const SceneCamera& camera : scene.cameras) names.push_back(siblings.take(camera.name));
    return names;
}

}  // namespace scree
