// assimp reads the formats. It stores coordinates as float, so an OBJ written with more digits
// loses them: an error of 6e-8 of the coordinate, which is below what modelling packages keep
// themselves.
#include "io/mesh_import.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>

#include <assimp/DefaultIOSystem.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include "core/base/error.h"
#include "io/byte_order.h"
#include "io/nearest_word.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kEndings = {"obj", "ply", "stl", "glb", "gltf", "fbx"};

// What a file may hold at most; far above what a shot can use.
constexpr std::uint32_t kMostNodes = 100'000, kMostPoints = 50'000'000, kLongestName = 1024;
constexpr int kDeepest = 256;

/// A mesh as it is handed from the child to the parent.
struct EncodedMesh {
    std::vector<double> points;         // three each
    std::vector<std::int32_t> corners;  // three a triangle
    std::vector<float> uvs;             // two a corner
    bool hasUvs = false;                // else they are all zero
};

std::string endingOf(const std::string& path)
{
    std::string ending = fs::path(path).extension().string();
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
    if (!fs::exists(path)) {
        throw Error(ErrorKind::missingInput, "mesh file '" + path + "' does not exist");
    }
    if (!fs::is_regular_file(path)) {
        throw Error(ErrorKind::badInput, "mesh file '" + path + "' is not a file");
    }
}

// ------------------------------------------------------------------ in the child: file → bytes

/// Opens files for reading, in the asset's folder and below; remembers what it refused.
class FolderSystem final : public Assimp::DefaultIOSystem {
public:
    explicit FolderSystem(const fs::path& folder) : folder_(folder) {}

    Assimp::IOStream* Open(const char* file, const char* mode) override
    {
        if (std::strpbrk(mode, "wa+") || !isInside(file)) return nullptr;
        return DefaultIOSystem::Open(file, mode);
    }
    bool Exists(const char* file) const override
    {
        return isInside(file) && DefaultIOSystem::Exists(file);
    }

    const std::string& refused() const { return refused_; }

private:
    bool isInside(const char* file) const
    {
        std::error_code code;
        const fs::path path = fs::weakly_canonical(file, code);
        const fs::path relative = path.lexically_relative(folder_);
        const bool isIn = !code && !relative.empty() && *relative.begin() != "..";
        if (!isIn) refused_ = file;
        return isIn;
    }

    fs::path folder_;
    mutable std::string refused_;
};

/// Leaves only the loaders of one file ending: a stranger's file does not choose its parser.
void keepLoadersOf(const std::string& ending, Assimp::Importer& importer)
{
    std::vector<Assimp::BaseImporter*> others;
    for (std::size_t i = 0; i < importer.GetImporterCount(); ++i) {
        const std::string endings =
            " " + std::string(importer.GetImporterInfo(i)->mFileExtensions) + " ";
        if (endings.find(" " + ending + " ") == std::string::npos) {
            others.push_back(importer.GetImporter(i));
        }
    }
    for (Assimp::BaseImporter* other : others) importer.UnregisterLoader(other);
}

void appendText(std::string& bytes, const std::string& text)
{
    appendBytes(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += text;
}

/// What a node shows, in the node's axes with its scale baked.
class NodeEncoder {
public:
    explicit NodeEncoder(const aiScene& scene) : scene_(scene) {}

    void visit(const aiNode& node, const aiMatrix4x4& fileFromParent, int depth)
    {
        if (depth > kDeepest) throw Error(ErrorKind::badInput, "its nodes are nested too deeply");
        const aiMatrix4x4 fileFromNode = fileFromParent * node.mTransformation;
        if (node.mNumMeshes > 0) encode(node, fileFromNode);
        for (unsigned i = 0; i < node.mNumChildren; ++i) {
            visit(*node.mChildren[i], fileFromNode, depth + 1);
        }
    }

    std::uint32_t count() const { return count_; }
    const std::string& bytes() const { return bytes_; }

private:
    void encode(const aiNode& node, const aiMatrix4x4& fileFromNode)
    {
        // Split the transform into what is rigid and the rest, which goes into the mesh.
        aiVector3D scale, position;
        aiQuaternion rotation;
        fileFromNode.Decompose(scale, rotation, position);
        const aiMatrix4x4 rigid(aiVector3D(1.0f), rotation, position);
        const bool isRigid = scale == aiVector3D(1.0f);
        const aiMatrix4x4 nodeFromMesh =
            isRigid ? aiMatrix4x4() : aiMatrix4x4(rigid).Inverse() * fileFromNode;

        EncodedMesh mesh;
        const bool isMirrored = nodeFromMesh.Determinant() < 0.0f;
        for (unsigned i = 0; i < node.mNumMeshes; ++i) {
            append(*scene_.mMeshes[node.mMeshes[i]], nodeFromMesh, isMirrored, mesh);
        }
        if (mesh.corners.empty()) return;
        ++count_;
        appendText(bytes_, node.mName.C_Str());
        for (const float value :
             {position.x, position.y, position.z, rotation.w, rotation.x, rotation.y, rotation.z}) {
            appendBytes(bytes_, static_cast<double>(value));
        }
        appendBytes(bytes_, static_cast<std::uint32_t>(mesh.points.size() / 3));
        bytes_ += bytesOf(mesh.points);
        appendBytes(bytes_, static_cast<std::uint32_t>(mesh.corners.size() / 3));
        bytes_ += bytesOf(mesh.corners);
        appendBytes(bytes_, static_cast<std::uint8_t>(mesh.hasUvs));
        if (mesh.hasUvs) bytes_ += bytesOf(mesh.uvs);
    }

    /// Of several sets of texture coordinates the first counts; meshes of a node without any get
    /// zeros when another has them.
    static void append(const aiMesh& mesh, const aiMatrix4x4& nodeFromMesh, bool isMirrored,
                       EncodedMesh& result)
    {
        const auto firstPoint = static_cast<std::int32_t>(result.points.size() / 3);
        for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
            const aiVector3D p = nodeFromMesh * mesh.mVertices[i];
            // Adding zero turns -0 into +0: the two are one point but not the same bits.
            result.points.insert(result.points.end(), {p.x + 0.0, p.y + 0.0, p.z + 0.0});
        }
        const aiVector3D* uvs = mesh.mTextureCoords[0];
        result.hasUvs = result.hasUvs || uvs != nullptr;
        for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
            const aiFace& face = mesh.mFaces[i];
            // Loose points and lines have no surface.
            if (face.mNumIndices != 3) continue;
            for (unsigned k = 0; k < 3; ++k) {
                // A node that mirrors would turn its triangles inside out.
                const unsigned corner = face.mIndices[isMirrored ? 2 - k : k];
                result.corners.push_back(firstPoint + static_cast<std::int32_t>(corner));
                const aiVector3D uv = uvs ? uvs[corner] : aiVector3D();
                result.uvs.insert(result.uvs.end(), {uv.x, uv.y});
            }
        }
    }

    const aiScene& scene_;
    std::uint32_t count_ = 0;
    std::string bytes_;
};

/// glTF is in metres by definition; FBX says how many centimetres its unit has. Others say nothing.
double metresPerUnitOf(const aiScene& scene, const std::string& ending)
{
    if (ending == "glb" || ending == "gltf") return 1.0;
    double centimetres = 0.0;
    float asFloat = 0.0f;
    if (ending != "fbx" || !scene.mMetaData) return 0.0;
    if (scene.mMetaData->Get("UnitScaleFactor", centimetres)) return 0.01 * centimetres;
    if (scene.mMetaData->Get("UnitScaleFactor", asFloat)) return 0.01 * asFloat;
    return 0.0;
}

std::string encodeFile(const std::string& path)
{
    const std::string ending = endingOf(path);
    Assimp::Importer importer;
    keepLoadersOf(ending, importer);
    auto* files = new FolderSystem(fs::weakly_canonical(fs::absolute(path)).parent_path());
    importer.SetIOHandler(files);  // which deletes it
    const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
    if (!files->refused().empty()) {
        throw Error(ErrorKind::badInput,
                    "it refers to '" + files->refused() + "', outside its own folder");
    }
    if (!scene || !scene->mRootNode) throw Error(ErrorKind::badInput, importer.GetErrorString());
    NodeEncoder encoder(*scene);
    encoder.visit(*scene->mRootNode, aiMatrix4x4(), 0);
    std::string bytes;
    appendBytes(bytes, metresPerUnitOf(*scene, ending));
    appendBytes(bytes, encoder.count());
    return bytes + encoder.bytes();
}

// ------------------------------------------------------------------ in the parent: bytes → meshes

/// Reads what the child wrote, believing none of it.
class Decoder {
public:
    Decoder(const std::string& bytes, std::string file) : bytes_(bytes), file_(std::move(file)) {}

    ImportedFile decode()
    {
        ImportedFile file;
        const auto metres = take<double>();
        if (std::isfinite(metres) && metres > 0.0) file.metresPerUnit = metres;
        const std::uint32_t count = takeCount(kMostNodes, "nodes");
        for (std::uint32_t i = 0; i < count; ++i) file.nodes.push_back(takeNode());
        if (file.nodes.empty()) refuse("has no faces");
        return file;
    }

private:
    template <class T>
    T take()
    {
        T value;
        takeBytes(&value, sizeof value);
        return value;
    }

    void takeBytes(void* target, std::size_t count)
    {
        if (count > bytes_.size() - next_) refuse("cannot be read: its reader's answer is cut");
        if (count > 0) std::memcpy(target, bytes_.data() + next_, count);
        next_ += count;
    }

    std::uint32_t takeCount(std::uint32_t most, const char* what)
    {
        const auto count = take<std::uint32_t>();
        if (count > most) {
            refuse("has more than " + std::to_string(most) + " " + what);
        }
        return count;
    }

    ImportedNode takeNode()
    {
        ImportedNode node;
        node.name.resize(takeCount(kLongestName, "letters in a name"));
        takeBytes(node.name.data(), node.name.size());
        std::array<double, 7> pose{};
        takeBytes(pose.data(), sizeof pose);
        const Quat turn(pose[3], pose[4], pose[5], pose[6]);
        node.fileFromNode = {{pose[0], pose[1], pose[2]}, turn.normalized()};

        TriMesh mesh;
        const std::uint32_t points = takeCount(kMostPoints, "points");
        requireLeft(points, 3 * sizeof(double));
        mesh.points.resize(3, points);
        takeBytes(mesh.points.data(), sizeof(double) * mesh.points.size());
        const std::uint32_t triangles = takeCount(kMostPoints, "triangles");
        requireLeft(triangles, 3 * sizeof(std::int32_t));
        mesh.triangles.resize(3, triangles);
        takeBytes(mesh.triangles.data(), sizeof(std::int32_t) * mesh.triangles.size());
        if (take<std::uint8_t>() != 0) {
            requireLeft(triangles, 6 * sizeof(float));
            mesh.cornerUvs.resize(2, mesh.triangles.size());
            takeBytes(mesh.cornerUvs.data(), sizeof(float) * mesh.cornerUvs.size());
        }

        const bool isFinite = mesh.points.allFinite() && node.fileFromNode.position.allFinite() &&
                              node.fileFromNode.orientation.coeffs().allFinite();
        if (!isFinite) refuse("has coordinates that are not finite");
        if (!mesh.cornerUvs.allFinite()) refuse("has texture coordinates that are not finite");
        if (triangles > 0 && (mesh.triangles.minCoeff() < 0 ||
                              mesh.triangles.maxCoeff() >= static_cast<int>(points))) {
            refuse("has a face with a corner that is no point");
        }
        node.mesh = mergeEqualPoints(mesh);
        return node;
    }

    /// Before memory is taken for them.
    void requireLeft(std::uint64_t count, std::uint64_t size)
    {
        if (count * size > bytes_.size() - next_) {
            refuse("cannot be read: its reader's answer is cut");
        }
    }

    [[noreturn]] void refuse(const std::string& why) const
    {
        throw Error(ErrorKind::badInput, "mesh file '" + file_ + "' " + why);
    }

    const std::string& bytes_;
    std::string file_;
    std::size_t next_ = 0;
};

}  // namespace

ImportedFile importFile(const std::string& path, const ConfinedLimits& limits)
{
    requireReadable(path);
    const std::string bytes = runConfined(
        "mesh file '" + path + "' cannot be read", [&] { return encodeFile(path); }, limits);
    ImportedFile file = Decoder(bytes, path).decode();
    file.isYUp = endingOf(path) == "glb" || endingOf(path) == "gltf";
    return file;
}

TriMesh joinedMesh(const ImportedFile& file)
{
    Eigen::Index points = 0, triangles = 0;
    bool hasUvs = false;
    for (const ImportedNode& node : file.nodes) {
        points += node.mesh.points.cols();
        triangles += node.mesh.triangles.cols();
        hasUvs = hasUvs || node.mesh.cornerUvs.cols() > 0;
    }
    TriMesh result{Points(3, points), Triangles(3, triangles)};
    if (hasUvs) result.cornerUvs = CornerUvs::Zero(2, 3 * triangles);
    Eigen::Index point = 0, triangle = 0;
    for (const ImportedNode& node : file.nodes) {
        const TriMesh placed = transformed(node.mesh, node.fileFromNode);
        const Eigen::Index pointCount = placed.points.cols(), faceCount = placed.triangles.cols();
        result.points.middleCols(point, pointCount) = placed.points;
        result.triangles.middleCols(triangle, faceCount) =
            placed.triangles.array() + static_cast<int>(point);
        if (placed.cornerUvs.cols() > 0) {
            result.cornerUvs.middleCols(3 * triangle, 3 * faceCount) = placed.cornerUvs;
        }
        point += pointCount;
        triangle += faceCount;
    }
    return mergeEqualPoints(result);
}

TriMesh importMesh(const std::string& path)
{
    return joinedMesh(importFile(path));
}

}  // namespace scree
