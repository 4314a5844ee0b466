#include "io/mesh_import_bytes.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/base/error.h"
#include "io/byte_order.h"

namespace scree {
namespace {

// What a file may hold at most; far above what a shot can use.
constexpr std::uint32_t kMostNodes = 100'000, kMostPoints = 50'000'000, kMostKeys = 10'000'000;
constexpr std::uint32_t kLongestText = 1024;

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
    Decoder(const std::string& bytes, const std::string& path) : bytes_(bytes), path_(path) {}

    ImportedFile decode()
    {
        ImportedFile file;
        const auto metres = take<double>();
        if (std::isfinite(metres) && metres > 0.0) file.metresPerUnit = metres;
        file.isYUp = take<std::uint8_t>() != 0;
        file.countsFramesFromZero = take<std::uint8_t>() != 0;
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

    std::string takeText(const char* what)
    {
        std::string text(takeCount(kLongestText, what), ' ');
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
        node.name = takeText("letters in a name");
        node.fileFromNode = takePose();
        node.obstacle = takeText("letters in a sentence");
        takeKeys(node);

        TriMesh mesh;
        takeColumns(mesh.points, kMostPoints, "points");
        takeColumns(mesh.triangles, kMostPoints, "triangles");
        takeColumns(mesh.cornerUvs, 3 * kMostPoints, "texture coordinates");
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
        node.mesh = mergeEqualPoints(mesh);
        return node;
    }

    void takeKeys(ImportedNode& node)
    {
        const std::uint32_t count = takeCount(kMostKeys, "keys");
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto seconds = take<double>();
            const bool isLater = node.keys.empty() || seconds > node.keys.back().seconds;
            if (!std::isfinite(seconds) || !isLater) refuse("has keys that are not in order");
            node.keys.push_back({seconds, takePose()});
        }
    }

    [[noreturn]] void refuse(const std::string& why) const
    {
        throw Error(ErrorKind::badInput, "mesh file '" + path_ + "' " + why);
    }

    const std::string& bytes_;
    const std::string& path_;
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
        appendBytes(bytes, static_cast<std::uint32_t>(node.keys.size()));
        for (const ImportedKey& key : node.keys) {
            appendBytes(bytes, key.seconds);
            appendPose(bytes, key.fileFromNode);
        }
        appendColumns(bytes, node.mesh.points);
        appendColumns(bytes, node.mesh.triangles);
        appendColumns(bytes, node.mesh.cornerUvs);
    }
    return bytes;
}

ImportedFile decodeImport(const std::string& bytes, const std::string& path)
{
    return Decoder(bytes, path).decode();
}

}  // namespace scree
