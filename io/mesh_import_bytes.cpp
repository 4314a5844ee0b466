#include "io/mesh_import_bytes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "core/base/error.h"
#include "io/byte_cursor.h"

namespace scree {
namespace {

constexpr std::uint32_t kMostKeys = 10'000'000;  // of a node
constexpr std::uint32_t kLongestSentence = 1024;
constexpr std::uint32_t kMostCorners = std::numeric_limits<std::uint32_t>::max();

void appendText(std::string& bytes, const std::string& text)
{
    appendBytes(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += text;
}

void appendPose(std::string& bytes, const Pose& pose)
{
    bytes += bytesOf(pose.position);
    bytes += bytesOf(pose.orientation.coeffs());
}

void appendKeys(std::string& bytes, const std::vector<ImportedKey>& keys)
{
    appendBytes(bytes, static_cast<std::uint32_t>(keys.size()));
    for (const ImportedKey& key : keys) {
        appendBytes(bytes, key.seconds);
        appendPose(bytes, key.fileFromNode);
        appendBytes(bytes, static_cast<std::uint8_t>(key.isBetween));
    }
}

/// Count of columns, then the numbers.
template <class Matrix>
void appendColumns(std::string& bytes, const Matrix& matrix)
{
    appendBytes(bytes, static_cast<std::uint32_t>(matrix.cols()));
    bytes += bytesOf(matrix);
}

/// Reads what the child wrote, believing none of it.
class Decoder {
public:
    Decoder(const std::string& bytes, const std::string& path, const ImportLimits& limits)
        : cursor_(bytes, [this] { refuse("cannot be read: its reader's answer is cut"); }),
          path_(path),
          limits_(limits)
    {
    }
    Decoder(const Decoder&) = delete;
    Decoder& operator=(const Decoder&) = delete;

    ImportedFile decode()
    {
        ImportedFile file;
        const auto metres = cursor_.take<double>();
        if (std::isfinite(metres) && metres > 0.0) file.metresPerUnit = metres;
        file.isYUp = cursor_.take<std::uint8_t>() != 0;
        file.countsFramesFromZero = cursor_.take<std::uint8_t>() != 0;
        file.upAxis = takeText(kLongestSentence, "letters in a sentence");
        const std::uint32_t count = takeCount(limits_.nodes, "nodes (--import-nodes)");
        for (std::uint32_t i = 0; i < count; ++i) file.nodes.push_back(takeNode());
        const std::uint32_t cameras = takeCount(limits_.nodes, "cameras (--import-nodes)");
        for (std::uint32_t i = 0; i < cameras; ++i) file.cameras.push_back(takeCamera());
        if (file.nodes.empty() && file.cameras.empty()) refuse("has no faces");
        return file;
    }

private:
    std::uint32_t takeCount(std::uint32_t most, const char* what)
    {
        const auto count = cursor_.take<std::uint32_t>();
        if (count > most) {
            refuse("has more than " + std::to_string(most) + " " + what);
        }
        return count;
    }

    std::string takeText(std::uint32_t most, const char* what)
    {
        return std::string(cursor_.takeText(takeCount(most, what)));
    }

    Pose takePose()
    {
        Pose pose;
        cursor_.takeInto(std::span(pose.position.data(), 3));
        cursor_.takeInto(std::span(pose.orientation.coeffs().data(), 4));
        pose.orientation.normalize();
        if (!pose.position.allFinite() || !pose.orientation.coeffs().allFinite()) {
            refuse("has coordinates that are not finite");
        }
        return pose;
    }

    template <class Matrix>
    void takeColumns(Matrix& matrix, std::uint32_t most, const char* what)
    {
        const std::uint32_t count = takeCount(most, what);
        const std::size_t size = std::size_t{count} * Matrix::RowsAtCompileTime;
        cursor_.require(size, sizeof(typename Matrix::Scalar));
        matrix.resize(Matrix::RowsAtCompileTime, count);
        cursor_.takeInto(std::span(matrix.data(), size));
    }

    ImportedNode takeNode()
    {
        ImportedNode node;
        node.name = takeText(limits_.nameLength, "letters in a name (--import-name)");
        node.fileFromNode = takePose();
        node.obstacle = takeText(kLongestSentence, "letters in a sentence");
        node.lostJoin = takeText(kLongestSentence, "letters in a sentence");
        node.lostClips = takeText(kLongestSentence, "letters in a sentence");
        node.unusable = takeText(kLongestSentence, "letters in a sentence");
        node.isBent = cursor_.take<std::uint8_t>() != 0;
        takeKeys(node.keys);

        TriMesh& mesh = node.mesh;
        takeColumns(mesh.points, limits_.points, "points (--import-points)");
        takeColumns(mesh.triangles, limits_.points, "triangles (--import-points)");
        // Not beyond what the caps of points allow, and never beyond what 32 bits can count.
        takeColumns(mesh.cornerUvs, 3 * std::min(limits_.points, kMostCorners / 3),
                    "texture coordinates");
        if (!mesh.points.allFinite()) refuse("has coordinates that are not finite");
        if (!mesh.cornerUvs.allFinite()) refuse("has texture coordinates that are not finite");
        if (mesh.cornerUvs.cols() > 0 && mesh.cornerUvs.cols() != mesh.triangles.size()) {
            refuse("has texture coordinates of other corners");
        }
        if (mesh.triangles.cols() > 0 &&
            (mesh.triangles.minCoeff() < 0 ||
             mesh.triangles.maxCoeff() >= static_cast<int>(mesh.points.cols()))) {
            refuse("has a face with a corner that is no point");
        }
        return node;
    }

    ImportedCamera takeCamera()
    {
        ImportedCamera camera;
        camera.name = takeText(limits_.nameLength, "letters in a name (--import-name)");
        camera.fileFromCamera = takePose();
        camera.fovDegrees = cursor_.take<double>();
        if (camera.fovDegrees != 0.0) requireFov(camera.fovDegrees, camera);
        takeKeys(camera.keys);
        const std::uint32_t count = takeCount(kMostKeys, "keys");
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto seconds = takeMoment(camera.zoom);
            camera.zoom.push_back({seconds, cursor_.take<double>()});
            requireFov(camera.zoom.back().fovDegrees, camera);
        }
        camera.isZoomLost = cursor_.take<std::uint8_t>() != 0;
        camera.lostJoin = takeText(kLongestSentence, "letters in a sentence");
        camera.lostClips = takeText(kLongestSentence, "letters in a sentence");
        camera.lostLens = takeText(kLongestSentence, "letters in a sentence");
        camera.unusable = takeText(kLongestSentence, "letters in a sentence");
        camera.filmAspect = cursor_.take<double>();
        if (!std::isfinite(camera.filmAspect) || camera.filmAspect < 0.0)
            refuse("has a camera '" + camera.name + "' with a film of no size");
        return camera;
    }

    void requireFov(double degrees, const ImportedCamera& camera) const
    {
        if (degrees > 0.0 && degrees < 180.0) return;
        refuse("has a camera '" + camera.name + "' without an angle of view");
    }

    /// When the key after those of `keys` is.
    template <class Key>
    double takeMoment(const std::vector<Key>& keys)
    {
        const auto seconds = cursor_.take<double>();
        const bool isLater = keys.empty() || seconds > keys.back().seconds;
        if (!std::isfinite(seconds) || !isLater) refuse("has keys that are not in order");
        return seconds;
    }

    void takeKeys(std::vector<ImportedKey>& keys)
    {
        const std::uint32_t count = takeCount(kMostKeys, "keys");
        for (std::uint32_t i = 0; i < count; ++i) {
            const double seconds = takeMoment(keys);
            const Pose pose = takePose();
            keys.push_back({seconds, pose, cursor_.take<std::uint8_t>() != 0});
        }
    }

    [[noreturn]] void refuse(const std::string& why) const
    {
        throw Error(ErrorKind::badInput, "mesh file '" + path_ + "' " + why);
    }

    ByteCursor cursor_;
    const std::string& path_;
    const ImportLimits& limits_;
};

}  // namespace

std::string encodeImport(const ImportedFile& file)
{
    std::string bytes;
    appendBytes(bytes, file.metresPerUnit.value_or(0.0));
    appendBytes(bytes, static_cast<std::uint8_t>(file.isYUp));
    appendBytes(bytes, static_cast<std::uint8_t>(file.countsFramesFromZero));
    appendText(bytes, file.upAxis);
    appendBytes(bytes, static_cast<std::uint32_t>(file.nodes.size()));
    for (const ImportedNode& node : file.nodes) {
        appendText(bytes, node.name);
        appendPose(bytes, node.fileFromNode);
        appendText(bytes, node.obstacle);
        appendText(bytes, node.lostJoin);
        appendText(bytes, node.lostClips);
        appendText(bytes, node.unusable);
        appendBytes(bytes, static_cast<std::uint8_t>(node.isBent));
        appendKeys(bytes, node.keys);
        appendColumns(bytes, node.mesh.points);
        appendColumns(bytes, node.mesh.triangles);
        appendColumns(bytes, node.mesh.cornerUvs);
    }
    appendBytes(bytes, static_cast<std::uint32_t>(file.cameras.size()));
    for (const ImportedCamera& camera : file.cameras) {
        appendText(bytes, camera.name);
        appendPose(bytes, camera.fileFromCamera);
        appendBytes(bytes, camera.fovDegrees);
        appendKeys(bytes, camera.keys);
        appendBytes(bytes, static_cast<std::uint32_t>(camera.zoom.size()));
        for (const ImportedZoom& key : camera.zoom) {
            appendBytes(bytes, key.seconds);
            appendBytes(bytes, key.fovDegrees);
        }
        appendBytes(bytes, static_cast<std::uint8_t>(camera.isZoomLost));
        appendText(bytes, camera.lostJoin);
        appendText(bytes, camera.lostClips);
        appendText(bytes, camera.lostLens);
        appendText(bytes, camera.unusable);
        appendBytes(bytes, camera.filmAspect);
    }
    return bytes;
}

ImportedFile decodeImport(const std::string& bytes, const std::string& path,
                          const ImportLimits& limits)
{
    return Decoder(bytes, path, limits).decode();
}

}  // namespace scree
