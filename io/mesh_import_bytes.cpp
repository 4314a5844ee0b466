#include "io/mesh_import_bytes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/base/error.h"
#include "io/byte_order.h"

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
        : bytes_(bytes), path_(path), limits_(limits)
    {
    }

    ImportedFile decode()
    {
        ImportedFile file;
        const auto metres = take<double>();
        if (std::isfinite(metres) && metres > 0.0) file.metresPerUnit = metres;
        file.isYUp = take<std::uint8_t>() != 0;
        file.countsFramesFromZero = take<std::uint8_t>() != 0;
        const std::uint32_t count = takeCount(limits_.nodes, "nodes (--import-nodes)");
        for (std::uint32_t i = 0; i < count; ++i) file.nodes.push_back(takeNode());
        const std::uint32_t cameras = takeCount(limits_.nodes, "cameras (--import-nodes)");
        for (std::uint32_t i = 0; i < cameras; ++i) file.cameras.push_back(takeCamera());
        if (file.nodes.empty() && file.cameras.empty()) refuse("has no faces");
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

    std::string takeText(std::uint32_t most, const char* what)
    {
        std::string text(takeCount(most, what), ' ');
        takeBytes(text.data(), text.size());
        return text;
    }

    Pose takePose()
    {
        Pose pose;
        takeBytes(pose.position.data(), 3 * sizeof(double));
        takeBytes(pose.orientation.coeffs().data(), 4 * sizeof(double));
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
        const std::uint64_t bytes =
            std::uint64_t{count} * Matrix::RowsAtCompileTime * sizeof(typename Matrix::Scalar);
        // Before memory is taken for them.
        if (bytes > bytes_.size() - next_) refuse("cannot be read: its reader's answer is cut");
        matrix.resize(Matrix::RowsAtCompileTime, count);
        takeBytes(matrix.data(), bytes);
    }

    ImportedNode takeNode()
    {
        ImportedNode node;
        node.name = takeText(limits_.nameLength, "letters in a name (--import-name)");
        node.fileFromNode = takePose();
        node.obstacle = takeText(kLongestSentence, "letters in a sentence");
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
        camera.fovDegrees = takeFov(camera);
        takeKeys(camera.keys);
        const std::uint32_t count = takeCount(kMostKeys, "keys");
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto seconds = takeMoment(camera.zoom);
            camera.zoom.push_back({seconds, takeFov(camera)});
        }
        camera.isZoomLost = take<std::uint8_t>() != 0;
        return camera;
    }

    double takeFov(const ImportedCamera& camera)
    {
        const auto degrees = take<double>();
        if (degrees > 0.0 && degrees < 180.0) return degrees;
        refuse("has a camera '" + camera.name + "' without an angle of view");
    }

    /// When the key after those of `keys` is.
    template <class Key>
    double takeMoment(const std::vector<Key>& keys)
    {
        const auto seconds = take<double>();
        const bool isLater = keys.empty() || seconds > keys.back().seconds;
        if (!std::isfinite(seconds) || !isLater) refuse("has keys that are not in order");
        return seconds;
    }

    void takeKeys(std::vector<ImportedKey>& keys)
    {
        const std::uint32_t count = takeCount(kMostKeys, "keys");
        for (std::uint32_t i = 0; i < count; ++i) {
            const double seconds = takeMoment(keys);
            keys.push_back({seconds, takePose()});
        }
    }

    [[noreturn]] void refuse(const std::string& why) const
    {
        throw Error(ErrorKind::badInput, "mesh file '" + path_ + "' " + why);
    }

    const std::string& bytes_;
    const std::string& path_;
    const ImportLimits& limits_;
    std::size_t next_ = 0;
};

}  // namespace

std::string encodeImport(const ImportedFile& file)
{
    std::string bytes;
    appendBytes(bytes, file.metresPerUnit.value_or(0.0));
    appendBytes(bytes, static_cast<std::uint8_t>(file.isYUp));
    appendBytes(bytes, static_cast<std::uint8_t>(file.countsFramesFromZero));
    appendBytes(bytes, static_cast<std::uint32_t>(file.nodes.size()));
    for (const ImportedNode& node : file.nodes) {
        appendText(bytes, node.name);
        appendPose(bytes, node.fileFromNode);
        appendText(bytes, node.obstacle);
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
    }
    return bytes;
}

ImportedFile decodeImport(const std::string& bytes, const std::string& path,
                          const ImportLimits& limits)
{
    return Decoder(bytes, path, limits).decode();
}

}  // namespace scree
