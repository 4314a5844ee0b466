// Writes the meshes that shots/bones_still.toml and shots/bones_500.toml use:
//   build/make_bones shots/meshes
// The meshes are kept with the project; this program says where they come from.
#include <cstdio>
#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/geometry/level_set_surface.h"
#include "core/geometry/mesh_decimation.h"
#include "core/geometry/mesh_defects.h"
#include "core/math/point_box.h"
#include "io/byte_order.h"
#include "io/file_bytes.h"
#include "tools/bones/bone_forms.h"
#include "tools/bones/funnel.h"

namespace scree {
namespace {

/// Fine enough that decimation decides where triangles go [m].
constexpr double kSpacing = 0.005;

/// As a binary PLY in single precision: half of what a take keeps, and imports read no more.
void writeSmallPly(const std::filesystem::path& path, const TriMesh& mesh)
{
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                        std::to_string(mesh.points.cols()) +
                        "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                        std::to_string(mesh.triangles.cols()) +
                        "\nproperty list uchar ushort vertex_indices\nend_header\n";
    for (Eigen::Index i = 0; i < mesh.points.size(); ++i) {
        appendBytes(bytes, static_cast<float>(mesh.points.data()[i]));
    }
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
        appendBytes(bytes, static_cast<std::uint8_t>(3));
        for (int k = 0; k < 3; ++k) {
            appendBytes(bytes, static_cast<std::uint16_t>(mesh.triangles(k, f)));
        }
    }
    writeFileBytes(path, bytes);
}

void writeSolid(const std::filesystem::path& folder, const std::string& name, const TriMesh& mesh)
{
    requireSolid(mesh, name);
    writeSmallPly(folder / (name + ".ply"), mesh);
    // Euler: points − edges + faces = 2 − 2 genus, with three half edges to a face.
    const long genus = 1 - (mesh.points.cols() - mesh.triangles.cols() / 2) / 2;
    const Aabb box = boxOf(mesh.points);
    std::printf("%-8s %6ld triangles, genus %ld, %.3f x %.3f x %.3f m, %.5f m3\n", name.c_str(),
                static_cast<long>(mesh.triangles.cols()), genus, box.size().x(), box.size().y(),
                box.size().z(), signedVolume(mesh));
}

int writeAll(const std::filesystem::path& folder)
{
    for (const BoneForm& form : boneForms()) {
        const TriMesh fine = surfaceOf(form.phi, form.box, kSpacing);
        writeSolid(folder, form.name, decimated(fine, form.triangleCount));
    }
    writeSolid(folder, "funnel", makeFunnel());
    return 0;
}

}  // namespace
}  // namespace scree

int main(int argumentCount, char** arguments)
{
    if (argumentCount != 2) {
        std::fprintf(stderr, "usage: make_bones FOLDER\n");
        return 64;
    }
    try {
        return scree::writeAll(arguments[1]);
    } catch (const scree::Error& error) {
        std::fprintf(stderr, "Error: %s\n", error.what());
        return 70;
    }
}
