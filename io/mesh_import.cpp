#include "io/mesh_import.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "core/base/error.h"
#include "io/alembic_import.h"
#include "io/file_bytes.h"
#include "io/gltf_reading.h"
#include "io/mesh_import_assimp.h"
#include "io/mesh_import_bytes.h"
#include "io/nearest_word.h"
#include "io/text_forms.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kEndings = {"obj", "ply", "stl", "glb", "gltf", "fbx", "abc"};

/// STL has no shared points, glTF none along seams, and the readers of OBJ and FBX take theirs
/// apart.
bool givesLoosePoints(const std::string& ending)
{
    return ending != "ply" && ending != "abc";
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

}  // namespace

ImportedFile importFile(const std::string& path, const ImportLimits& limits)
{
    requireReadable(path);
    const std::string ending = endingOf(path);
    const auto read = [&] {
        return encodeImport(ending == "abc" ? importAlembic(path, limits.depth)
                                            : importWithAssimp(path, ending, limits.depth));
    };
    ImportedFile file = decodeImport(
        runConfined("mesh file '" + path + "' cannot be read", read, limits.process), path, limits);
    file.hadLoosePoints = givesLoosePoints(ending);
    if (!file.hadLoosePoints) return file;
    for (ImportedNode& node : file.nodes) {
        node.mesh = mergeEqualPoints(node.mesh, FlatTriangles::keep);
    }
    return file;
}

std::vector<std::string> partsOfAsset(const std::string& path)
{
    const std::string ending = endingOf(path);
    std::vector<std::string> parts;
    if (ending != "gltf" && ending != "glb") return parts;
    for (const std::string& buffer : readGltf(readFileBytes(path)).buffers) {
        const fs::path name = fs::path(buffer).lexically_normal();
        const fs::path part = fs::path(path).parent_path() / name;
        const bool isInside = !name.is_absolute() && *name.begin() != "..";
        if (isInside && isThere(part)) parts.push_back(part.string());
    }
    return parts;
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
    return file.hadLoosePoints ? mergeEqualPoints(result, FlatTriangles::keep) : result;
}

std::string refusalOf(const ImportedNode& node, const std::string& path)
{
    return "mesh file '" + path + "' has a mesh '" + node.name + "' that " + node.unusable;
}

TriMesh joinedMesh(const ImportedFile& file, const std::string& path)
{
    for (const ImportedNode& node : file.nodes) {
        if (!node.unusable.empty()) throw Error(ErrorKind::badInput, refusalOf(node, path));
    }
    return joinedMesh(file);
}

}  // namespace scree
