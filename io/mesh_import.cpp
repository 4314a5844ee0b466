// assimp reads the formats. It stores coordinates as float, so an OBJ written with more digits
// loses them: an error of 6e-8 of the coordinate, which is below what modelling packages keep
// themselves.
#include "io/mesh_import.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <vector>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include "core/base/error.h"
#include "io/nearest_word.h"

namespace scree {
namespace {

const std::vector<std::string> kEndings = {"obj", "ply", "stl"};

std::string endingOf(const std::string& path)
{
    std::string ending = std::filesystem::path(path).extension().string();
    if (!ending.empty()) ending.erase(0, 1);
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return ending;
}

void requireReadable(const std::string& path)
{
    const std::string ending = endingOf(path);
    if (std::find(kEndings.begin(), kEndings.end(), ending) == kEndings.end()) {
        throw Error(ErrorKind::badInput, "mesh file '" + path + "' has an ending that cannot be " +
                                             "read; supported: " + joined(kEndings));
    }
    if (!std::filesystem::exists(path)) {
        throw Error(ErrorKind::missingInput, "mesh file '" + path + "' does not exist");
    }
    if (!std::filesystem::is_regular_file(path)) {
        throw Error(ErrorKind::badInput, "mesh file '" + path + "' is not a file");
    }
}

/// Appends what the nodes of a scene hold, each mesh as often as a node shows it.
class MeshCollector {
public:
    explicit MeshCollector(const aiScene& scene) : scene_(scene) {}

    void collect(const aiNode& node, const aiMatrix4x4& fileFromParent)
    {
        const aiMatrix4x4 fileFromNode = fileFromParent * node.mTransformation;
        for (unsigned i = 0; i < node.mNumMeshes; ++i) {
            append(*scene_.mMeshes[node.mMeshes[i]], fileFromNode);
        }
        for (unsigned i = 0; i < node.mNumChildren; ++i) collect(*node.mChildren[i], fileFromNode);
    }

    TriMesh mesh() const
    {
        TriMesh result;
        result.points.resize(3, static_cast<Eigen::Index>(points_.size()));
        for (std::size_t i = 0; i < points_.size(); ++i) result.points.col(i) = points_[i];
        result.triangles.resize(3, static_cast<Eigen::Index>(corners_.size() / 3));
        std::copy(corners_.begin(), corners_.end(), result.triangles.data());
        return result;
    }

private:
    void append(const aiMesh& mesh, const aiMatrix4x4& fileFromNode)
    {
        const int firstPoint = static_cast<int>(points_.size());
        for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
            const aiVector3D p = fileFromNode * mesh.mVertices[i];
            // Adding zero turns -0 into +0: the two are one point but not the same bits.
            points_.emplace_back(p.x + 0.0, p.y + 0.0, p.z + 0.0);
        }
        // A node that mirrors would turn its triangles inside out.
        const bool isMirrored = fileFromNode.Determinant() < 0.0f;
        for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
            const aiFace& face = mesh.mFaces[i];
            // Loose points and lines have no surface.
            if (face.mNumIndices != 3) continue;
            for (unsigned k = 0; k < 3; ++k) {
                const unsigned corner = face.mIndices[isMirrored ? 2 - k : k];
                corners_.push_back(firstPoint + static_cast<int>(corner));
            }
        }
    }

    const aiScene& scene_;
    std::vector<Vec3> points_;
    std::vector<int> corners_;
};

}  // namespace

TriMesh importMesh(const std::string& path)
{
    requireReadable(path);
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
    if (!scene || !scene->mRootNode) {
        throw Error(ErrorKind::badInput,
                    "mesh file '" + path + "' cannot be read: " + importer.GetErrorString());
    }

    MeshCollector collector(*scene);
    collector.collect(*scene->mRootNode, aiMatrix4x4());
    const TriMesh mesh = mergeEqualPoints(collector.mesh());
    if (mesh.triangles.cols() == 0) {
        throw Error(ErrorKind::badInput, "mesh file '" + path + "' has no faces");
    }
    if (!mesh.points.allFinite()) {
        throw Error(ErrorKind::badInput,
                    "mesh file '" + path + "' has coordinates that are not finite");
    }
    return mesh;
}

}  // namespace scree
