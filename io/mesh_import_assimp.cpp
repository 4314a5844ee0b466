#include "io/mesh_import_assimp.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>

#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include "core/base/error.h"
#include "io/fbx_lens.h"
#include "io/file_bytes.h"
#include "io/gltf_reading.h"
#include "io/mesh_import_nodes.h"
#include "io/obj_names.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

/// Opens files for reading, in the asset's folder and below; remembers what it refused.
class FolderSystem final : public Assimp::DefaultIOSystem {
public:
    explicit FolderSystem(const std::string& asset)
        : folder_(fs::absolute(asset).lexically_normal().parent_path())
    {
    }

    Assimp::IOStream* Open(const char* file, const char* mode) override
    {
        if (std::strpbrk(mode, "wa+") || !isInside(file)) return nullptr;
        if (!mainText_.empty() && mainFile_ == file) {
            return new Assimp::MemoryIOStream(
                reinterpret_cast<const std::uint8_t*>(mainText_.data()), mainText_.size());
        }
        return DefaultIOSystem::Open(file, mode);
    }
    bool Exists(const char* file) const override
    {
        return isInside(file) && DefaultIOSystem::Exists(file);
    }

    /// Gives a file this text, whatever the disk has.
    void replace(const std::string& file, std::string text)
    {
        mainFile_ = file;
        mainText_ = std::move(text);
    }

    const std::string& refused() const { return refused_; }

private:
    /// By the name as it is written: where links lead is up to who has put them there. Stores and
    /// version control keep what stands in one folder in many.
    bool isInside(const char* file) const
    {
        const fs::path path = fs::absolute(file).lexically_normal();
        const fs::path relative = path.lexically_relative(folder_);
        const bool isIn = !relative.empty() && *relative.begin() != "..";
        if (!isIn) refused_ = file;
        return isIn;
    }

    fs::path folder_;
    std::string mainFile_, mainText_;
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

/// Whether a file animates a lens, which assimp passes over: FBX as a curve of a focal length or an
/// angle, in words or in binary, glTF by an extension that points at the angle.
bool animatesLens(const std::string& path)
{
    using namespace std::string_literals;
    std::ifstream file(path, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    for (const std::string& name : {"FocalLength"s, "FieldOfView"s, "FieldOfViewX"s}) {
        if (bytes.find("AnimCurveNode::" + name + "\"") != std::string::npos) return true;
        if (bytes.find(name + "\0\1AnimCurveNode"s) != std::string::npos) return true;
    }
    return bytes.find("/perspective/yfov") != std::string::npos;
}

/// Whether a PLY file has all of its header: assimp goes on looking for the rest for a minute.
bool endsItsHeader(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    std::string line;
    while (std::getline(file, line) && !line.starts_with("end_header")) {
    }
    return file.good() || line.starts_with("end_header");
}

/// Whether the texture coordinates of a PLY file belong to faces. assimp gives points that faces
/// share the coordinates of the last face, which along a seam are those of the wrong side.
bool hasUvsOfFaces(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    for (std::string line; std::getline(file, line) && !line.starts_with("end_header");) {
        if (line.starts_with("property list") && line.find("texcoord") != std::string::npos) {
            return true;
        }
    }
    return false;
}

/// glTF is in metres by definition; FBX says how many centimetres its unit has. Others say nothing.
std::optional<double> metresPerUnitOf(const aiScene& scene, const std::string& ending)
{
    if (ending == "glb" || ending == "gltf") return 1.0;
    double centimetres = 0.0;
    float asFloat = 0.0f;
    if (ending != "fbx" || !scene.mMetaData) return std::nullopt;
    if (scene.mMetaData->Get("UnitScaleFactor", centimetres)) return 0.01 * centimetres;
    if (scene.mMetaData->Get("UnitScaleFactor", asFloat)) return 0.01 * asFloat;
    return std::nullopt;
}

/// Which way an FBX file says is up; its reader turns nothing.
std::string upAxisOf(const aiScene& scene, const std::string& ending)
{
    std::int32_t axis = 0, sign = 1;
    if (ending != "fbx" || !scene.mMetaData || !scene.mMetaData->Get("UpAxis", axis)) return "";
    scene.mMetaData->Get("UpAxisSign", sign);
    if (axis < 0 || axis > 2) return "";
    return std::string(sign < 0 ? "-" : "+") + "xyz"[axis];
}

}  // namespace

ImportedFile importWithAssimp(const std::string& path, const std::string& ending,
                              std::uint32_t mostDepth)
{
    const bool isGltf = ending == "glb" || ending == "gltf";
    const GltfReading gltf = isGltf ? readGltf(readFileBytes(path)) : GltfReading();
    if (isGltf && !gltf.isReadable)
        throw Error(ErrorKind::badInput, "its JSON is damaged, or has letters that are not UTF-8");
    if (!gltf.lostExtension.empty())
        throw Error(ErrorKind::badInput, "it uses the glTF extension " + gltf.lostExtension +
                                             ", which is not read here: export it without");
    if (!gltf.looselySkinned.empty())
        throw Error(ErrorKind::badInput, "bones bend its node '" + gltf.looselySkinned +
                                             "' without 'inverseBindMatrices', which are needed "
                                             "here: export it with its deformers applied");
    if (ending == "ply" && !endsItsHeader(path))
        throw Error(ErrorKind::badInput, "its header has no end: the file is cut short");
    Assimp::Importer importer;
    keepLoadersOf(ending, importer);
    auto* files = new FolderSystem(path);
    importer.SetIOHandler(files);  // which deletes it
    if (ending == "obj") {
        std::optional<std::string> text = textWithObjNames(readFileBytes(path));
        if (text) files->replace(path, std::move(*text));
    }
    const aiScene* scene = importer.ReadFile(path, 0);
    if (!files->refused().empty()) {
        throw Error(ErrorKind::badInput,
                    "it refers to '" + files->refused() + "', outside its own folder");
    }
    const std::string problem = importer.GetErrorString();
    // The library tells of it in no other way; whoever limits the memory has words for it.
    if (problem.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
    if (!scene || !scene->mRootNode) throw Error(ErrorKind::badInput, problem);
    ImportedFile file;
    const FbxLens lens = ending == "fbx" ? readFbxLens(readFileBytes(path)) : FbxLens();
    readNodes(*scene, isGltf ? &gltf : nullptr, ending == "fbx" ? &lens : nullptr, mostDepth, file);
    const bool isZoomLost = !file.cameras.empty() && animatesLens(path);
    for (ImportedCamera& camera : file.cameras) camera.isZoomLost = isZoomLost;
    if (ending == "ply" && hasUvsOfFaces(path)) {
        for (ImportedNode& node : file.nodes) node.mesh.cornerUvs.resize(2, 0);
    }
    file.metresPerUnit = metresPerUnitOf(*scene, ending);
    file.isYUp = isGltf;
    file.upAxis = upAxisOf(*scene, ending);
    return file;
}

}  // namespace scree
