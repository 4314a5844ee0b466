#include "io/ply_mesh.h"

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "io/byte_order.h"
#include "io/file_bytes.h"

namespace scree {

namespace {

constexpr std::size_t kPointBytes = 3 * sizeof(double);
constexpr std::size_t kCornersBytes = 1 + 3 * sizeof(std::int32_t);
constexpr std::size_t kUvsBytes = 1 + 6 * sizeof(float);
constexpr char kCornerCount = 3, kUvCount = 6;

std::string headerOf(std::uint64_t pointCount, std::uint64_t faceCount, bool hasUvs)
{
    return "ply\n"
           "format binary_little_endian 1.0\n"
           "element vertex " +
           std::to_string(pointCount) +
           "\n"
           "property double x\n"
           "property double y\n"
           "property double z\n"
           "element face " +
           std::to_string(faceCount) +
           "\n"
           "property list uchar int vertex_indices\n" +
           (hasUvs ? "property list uchar float texcoord\n" : "") + "end_header\n";
}

/// The number behind "element <name> ".
std::optional<std::uint64_t> readCount(std::string_view bytes, std::string_view name)
{
    const std::string key = "element " + std::string(name) + " ";
    const std::size_t begin = bytes.substr(0, headerOf(~0ull, ~0ull, true).size()).find(key);
    if (begin == std::string_view::npos) return std::nullopt;
    std::uint64_t count = 0;
    const char* end = bytes.data() + bytes.size();
    const auto result = std::from_chars(bytes.data() + begin + key.size(), end, count);
    return result.ec == std::errc() ? std::optional(count) : std::nullopt;
}

[[noreturn]] void failDamaged(const std::filesystem::path& path, const std::string& what)
{
    throw Error(ErrorKind::inputOutput, "the mesh \"" + path.string() + "\" is damaged: " + what);
}

/// The corners of the face that `bytes` begin with.
Eigen::Vector3i readCorners(const std::filesystem::path& path, std::string_view bytes,
                            Eigen::Index face, Eigen::Index pointCount)
{
    if (bytes.front() != kCornerCount) failDamaged(path, "a face is not a triangle");
    Eigen::Vector3i corners;
    for (Eigen::Index corner = 0; corner < 3; ++corner) {
        const auto point = readBytes<std::int32_t>(bytes, 1 + 4 * static_cast<std::size_t>(corner));
        if (point < 0 || point >= pointCount) {
            failDamaged(path, "triangle " + std::to_string(face) + " names point " +
                                  std::to_string(point) + " of " + std::to_string(pointCount));
        }
        corners[corner] = point;
    }
    return corners;
}

/// The texture coordinates that stand behind those corners.
Eigen::Matrix<float, 2, 3> readUvs(const std::filesystem::path& path, std::string_view bytes)
{
    bytes.remove_prefix(kCornersBytes);
    if (bytes.front() != kUvCount) failDamaged(path, "a face has not six texture coordinates");
    Eigen::Matrix<float, 2, 3> uvs;
    std::memcpy(uvs.data(), bytes.data() + 1, sizeof uvs);
    if (!uvs.allFinite()) failDamaged(path, "a texture coordinate is not finite");
    return uvs;
}

}  // namespace

std::string encodePlyMesh(const TriMesh& mesh)
{
    const bool hasUvs = mesh.cornerUvs.cols() > 0;
    std::string bytes = headerOf(static_cast<std::uint64_t>(mesh.points.cols()),
                                 static_cast<std::uint64_t>(mesh.triangles.cols()), hasUvs);
    bytes += bytesOf(mesh.points);
    for (Eigen::Index face = 0; face < mesh.triangles.cols(); ++face) {
        const Eigen::Vector3i corners = mesh.triangles.col(face);
        bytes.append(reinterpret_cast<const char*>(&kCornerCount), 1);
        bytes += bytesOf(corners);
        if (!hasUvs) continue;
        const Eigen::Matrix<float, 2, 3> uvs = mesh.cornerUvs.middleCols<3>(3 * face);
        bytes.append(reinterpret_cast<const char*>(&kUvCount), 1);
        bytes += bytesOf(uvs);
    }
    return bytes;
}

TriMesh readPlyMesh(const std::filesystem::path& path)
{
    const std::string bytes = readFileBytes(path);

    // Rebuild the header from its two counts: it must be one of those we write.
    const std::optional<std::uint64_t> pointCount = readCount(bytes, "vertex");
    const std::optional<std::uint64_t> faceCount = readCount(bytes, "face");
    if (!pointCount || !faceCount) failDamaged(path, "its header is not complete");
    const bool hasUvs = bytes.starts_with(headerOf(*pointCount, *faceCount, true));
    const std::string header = headerOf(*pointCount, *faceCount, hasUvs);
    if (!bytes.starts_with(header)) failDamaged(path, "its header is not one written by Scree");
    std::string_view body = std::string_view(bytes).substr(header.size());

    // Bound the counts before multiplying them.
    const std::size_t faceBytes = kCornersBytes + (hasUvs ? kUvsBytes : 0);
    if (*pointCount > body.size() || *faceCount > body.size() ||
        *pointCount * kPointBytes + *faceCount * faceBytes != body.size()) {
        failDamaged(path, std::to_string(*pointCount) + " points and " +
                              std::to_string(*faceCount) + " triangles do not take " +
                              std::to_string(body.size()) + " bytes");
    }

    TriMesh mesh;
    mesh.points.resize(3, static_cast<Eigen::Index>(*pointCount));
    std::memcpy(mesh.points.data(), body.data(), *pointCount * kPointBytes);
    body.remove_prefix(*pointCount * kPointBytes);

    mesh.triangles.resize(3, static_cast<Eigen::Index>(*faceCount));
    if (hasUvs) mesh.cornerUvs.resize(2, mesh.triangles.size());
    for (Eigen::Index face = 0; face < mesh.triangles.cols(); ++face) {
        mesh.triangles.col(face) = readCorners(path, body, face, mesh.points.cols());
        if (hasUvs) mesh.cornerUvs.middleCols<3>(3 * face) = readUvs(path, body);
        body.remove_prefix(faceBytes);
    }
    return mesh;
}

}  // namespace scree
