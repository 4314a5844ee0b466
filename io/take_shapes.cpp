#include "io/take_shapes.h"

#include <string>

#include "core/base/hash.h"
#include "io/file_bytes.h"
#include "io/ply_mesh.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

std::string plyOf(const SceneMesh& mesh)
{
    return encodePlyMesh({mesh.points, mesh.triangles, mesh.cornerUvs});
}

std::vector<const SceneMesh*> keptMeshes(const SceneDescription& scene)
{
    std::vector<const SceneMesh*> kept;
    for (const SceneMesh& mesh : scene.meshes)
        if (!mesh.isPlane) kept.push_back(&mesh);
    return kept;
}

}  // namespace

std::vector<TakeShape> shapesOf(const SceneDescription& scene)
{
    std::vector<TakeShape> shapes;
    for (const SceneMesh* mesh : keptMeshes(scene))
        shapes.push_back({mesh->name, hashText(plyOf(*mesh))});
    return shapes;
}

std::vector<fs::path> writeShapes(const TakePaths& paths, const SceneDescription& scene)
{
    createFolder(paths.shapes());
    std::vector<fs::path> replaced;
    for (const SceneMesh* mesh : keptMeshes(scene)) {
        const fs::path path = paths.shape(mesh->name);
        const std::string bytes = plyOf(*mesh);
        if (isThere(path)) {
            if (readFileBytes(path) == bytes) continue;
            replaced.push_back(path);
        }
        writeFileBytes(path, bytes);
    }
    return replaced;
}

}  // namespace scree
