#include "io/mesh_sequence_writer.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "core/base/error.h"
#include "io/atomic_file.h"
#include "io/byte_order.h"
#include "io/frame_pattern.h"
#include "io/number_text.h"

namespace scree {

namespace {

namespace fs = std::filesystem;

using WriteOneFrame = void (*)(AtomicFile& file, const SceneDescription& scene,
                               const SceneFrame& frame);

class MeshSequenceWriter final : public FrameWriter {
public:
    MeshSequenceWriter(fs::path output, WriteOneFrame writeOneFrame)
        : output_(std::move(output)), writeOneFrame_(writeOneFrame)
    {
    }

private:
    void beginScene(const SceneDescription& scene, int firstFrame, int /*frameCount*/) override
    {
        scene_ = &scene;
        const AtomicFile probe(fileOf(firstFrame));  // fails now rather than after the first frame
    }

    void writeFrame(const SceneFrame& frame) override
    {
        AtomicFile file(fileOf(frame.frame));
        writeOneFrame_(file, *scene_, frame);
        file.commit();
    }

    void finishScene(const FinishWatch& /*watch*/) override {}

    fs::path fileOf(int frame) const { return framePath(output_.string(), frame); }

    fs::path output_;
    WriteOneFrame writeOneFrame_;
    const SceneDescription* scene_ = nullptr;
};

void writeObjFrame(AtomicFile& file, const SceneDescription& scene, const SceneFrame& frame)
{
    std::uint64_t firstPoint = 1, nextUv = 1;  // OBJ counts from 1
    std::string text;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        if (!isSeen(scene.bodies[b], frame.frame)) continue;
        const SceneMesh& mesh = scene.meshes[scene.bodies[b].mesh];
        text = "o " + scene.bodies[b].name + "\n";
        for (Eigen::Index v = 0; v < mesh.points.cols(); ++v) {
            const Vec3 xWorld = frame.worldFromAsset[b] * mesh.points.col(v);
            text += 'v';
            for (const double coordinate : xWorld) appendNumber(text += ' ', coordinate);
            text += '\n';
        }
        const bool hasUvs = mesh.cornerUvs.cols() > 0;
        for (const auto uv : mesh.cornerUvs.colwise()) {
            appendNumber(text += "vt ", uv.x());
            appendNumber(text += ' ', uv.y());
            text += '\n';
        }
        for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
            text += 'f';
            for (const int corner : mesh.triangles.col(f)) {
                appendNumber(text += ' ', firstPoint + static_cast<std::uint64_t>(corner));
                if (hasUvs) appendNumber(text += '/', nextUv++);
            }
            text += '\n';
        }
        firstPoint += static_cast<std::uint64_t>(mesh.points.cols());
        file.write(text);
    }
}

bool hasUvs(const SceneDescription& scene)
{
    const auto has = [](const SceneMesh& mesh) { return mesh.cornerUvs.cols() > 0; };
    return std::any_of(scene.meshes.begin(), scene.meshes.end(), has);
}

/// The list of texture coordinates of a face; empty where the mesh has none but another has.
void appendPlyUvs(std::string& bytes, const SceneMesh& mesh, Eigen::Index face)
{
    const bool hasSome = mesh.cornerUvs.cols() > 0;
    appendBytes(bytes, static_cast<std::uint8_t>(hasSome ? 6 : 0));
    if (!hasSome) return;
    const Eigen::Matrix<float, 2, 3> uvs = mesh.cornerUvs.middleCols<3>(3 * face);
    bytes += bytesOf(uvs);
}

std::string plyHeader(const SceneDescription& scene, int frame)
{
    std::uint64_t pointCount = 0, faceCount = 0;
    std::string bodies;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        if (!isSeen(scene.bodies[b], frame)) continue;
        const SceneMesh& mesh = scene.meshes[scene.bodies[b].mesh];
        pointCount += static_cast<std::uint64_t>(mesh.points.cols());
        faceCount += static_cast<std::uint64_t>(mesh.triangles.cols());
        bodies += "comment body " + std::to_string(b) + " " + scene.bodies[b].name + "\n";
    }
    if (pointCount > std::numeric_limits<std::int32_t>::max()) {
        throw Error(ErrorKind::badInput, "the scene has " + std::to_string(pointCount) +
                                             " points, more than a PLY file can number");
    }
    return "ply\nformat binary_little_endian 1.0\ncomment frame " + std::to_string(frame) + "\n" +
           bodies + "element vertex " + std::to_string(pointCount) +
           "\n"
           "property double x\nproperty double y\nproperty double z\n"
           "property float vx\nproperty float vy\nproperty float vz\n"
           "property int body\n"
           "element face " +
           std::to_string(faceCount) +
           "\n"
           "property list uchar int vertex_indices\n" +
           (hasUvs(scene) ? "property list uchar float texcoord\n" : "") + "end_header\n";
}

void writePlyFrame(AtomicFile& file, const SceneDescription& scene, const SceneFrame& frame)
{
    file.write(plyHeader(scene, frame.frame));

    // Points of all bodies.
    std::string bytes;
    for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
        if (!isSeen(scene.bodies[b], frame.frame)) continue;
        const Points& points = scene.meshes[scene.bodies[b].mesh].points;
        const Pose& worldFromAsset = frame.worldFromAsset[b];
        bytes.clear();
        for (Eigen::Index v = 0; v < points.cols(); ++v) {
            const Vec3 arm = worldFromAsset.orientation * points.col(v);
            const Vec3 xWorld = worldFromAsset.position + arm;
            const Vec3 velocity = frame.velocity[b] + frame.angularVelocity[b].cross(arm);
            bytes += bytesOf(xWorld);
            for (const double component : velocity) {
                appendBytes(bytes, static_cast<float>(component));
            }
            appendBytes(bytes, static_cast<std::int32_t>(b));
        }
        file.write(bytes);
    }

    // Triangles of all bodies.
    std::int32_t firstPoint = 0;
    const bool withUvs = hasUvs(scene);
    for (const SceneBody& body : scene.bodies) {
        if (!isSeen(body, frame.frame)) continue;
        const SceneMesh& mesh = scene.meshes[body.mesh];
        bytes.clear();
        for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f) {
            appendBytes(bytes, std::uint8_t{3});
            for (const int corner : mesh.triangles.col(f)) appendBytes(bytes, firstPoint + corner);
            if (withUvs) appendPlyUvs(bytes, mesh, f);
        }
        firstPoint += static_cast<std::int32_t>(mesh.points.cols());
        file.write(bytes);
    }
}

}  // namespace

std::unique_ptr<FrameWriter> makeObjSequenceWriter(const fs::path& output)
{
    return std::make_unique<MeshSequenceWriter>(output, writeObjFrame);
}

std::unique_ptr<FrameWriter> makePlySequenceWriter(const fs::path& output)
{
    return std::make_unique<MeshSequenceWriter>(output, writePlyFrame);
}

}  // namespace scree
