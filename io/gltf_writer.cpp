// A .glb file is a header, one chunk of JSON that describes everything, and one chunk of bytes that
// it points into. The description comes first, so it is made before a byte of motion is written:
// where each track will lie follows from the number of times.
#include "io/gltf_writer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/base/check.h"
#include "core/base/error.h"
#include "core/math/rotation.h"
#include "core/picture/camera_motion.h"
#include "core/picture/shaded_mesh.h"
#include "io/atomic_file.h"
#include "io/byte_order.h"
#include "io/camera_names.h"
#include "io/camera_pose.h"
#include "io/motion_spool.h"

namespace scree {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Numbers of the glTF specification.
constexpr std::uint32_t kMagic = 0x46546c67, kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
constexpr int kFloat = 5126, kUnsignedInt = 5125;
constexpr int kVertexBuffer = 34962, kIndexBuffer = 34963;

constexpr std::uint64_t kTranslationBytes = 3 * sizeof(float);
constexpr std::uint64_t kRotationBytes = 4 * sizeof(float);

/// Bodies alike in both show the same glTF mesh: there a mesh has its material.
using MeshAndMaterial = std::pair<std::size_t, std::string>;

/// Accessors of a mesh's data.
struct MeshAccessors {
    std::size_t points = 0, normals = 0, indices = 0;
    std::optional<std::size_t> uvs;
};

/// Whether a body's translation and rotation ever change.
struct Changes {
    bool translation = false, rotation = false;
};

template <class Vector>
Json jsonArray(const Vector& values)
{
    Json array = Json::array();
    for (const auto value : values) array.push_back(static_cast<double>(value));
    return array;
}

Json jsonQuaternion(const Quat& q)
{
    return jsonArray(q.coeffs().cast<float>().eval());  // Eigen's order is glTF's: x y z w
}

/// Turns a z-up shot's axes into y-up ones: (x, y, z) → (x, z, −y).
Quat yUpFromShot(bool zUp)
{
    const double half = std::sqrt(0.5);
    return zUp ? Quat(half, -half, 0.0, 0.0) : Quat::Identity();
}

/// A pose of the shot in the axes and the unit of glTF.
Pose inYUpMetres(const Pose& pose, const SceneDescription& scene)
{
    const Quat turn = yUpFromShot(scene.zUp);
    return {scene.metresPerUnit * (turn * pose.position), (turn * pose.orientation).normalized()};
}

std::string paddedTo4(std::string bytes, char filling)
{
    bytes.resize((bytes.size() + 3) / 4 * 4, filling);
    return bytes;
}

/// All motion is read from the spool twice.
constexpr double kFinishCost = 1.0;

class GltfWriter final : public FrameWriter {
public:
    explicit GltfWriter(fs::path output) : output_(std::move(output)) {}

    bool holdsSubframes() const override { return true; }
    double finishCost() const override { return kFinishCost; }
    std::vector<std::string> losses(const SceneDescription& scene) const override;

private:
    void beginScene(const SceneDescription& scene, int firstFrame, int frameCount) override;
    void writeFrame(const SceneFrame& frame) override;
    void finishScene(const FinishWatch& watch) override;

    std::size_t addView(std::uint64_t byteCount, std::optional<int> target);
    std::size_t addAccessor(std::size_t view, std::uint64_t offset, std::size_t count,
                            const char* type, int componentType);
    std::optional<MeshAccessors> addMeshData(const SceneMesh& mesh);
    std::optional<std::size_t> addMesh(const SceneBody& body);
    void addMaterials();
    void addCameras(Json& rootNodes);
    void addBodies(Json& rootNodes);
    void addAnimation();
    void addBirths(Json& samplers, Json& channels);
    void addCameraMotion(Json& samplers, Json& channels);
    std::size_t addTimes(const std::vector<float>& times);
    std::size_t addValues(const std::vector<float>& values, std::size_t count, const char* type);
    void addChannel(Json& samplers, Json& channels, std::size_t node, const char* path,
                    const char* interpolation, std::size_t input, std::size_t output);
    void writeMotion(const FinishWatch& watch);

    double secondsOf(double frame) const { return (frame - firstFrame_) / scene_->framesPerSecond; }

    fs::path output_;
    const SceneDescription* scene_ = nullptr;
    int firstFrame_ = 0;
    std::optional<AtomicFile> file_;
    std::optional<MotionSpool> motion_;  // of the bodies that move
    std::vector<Pose> firstPoses_;       // of all
    std::vector<Changes> changes_;       // of all

    Json json_;
    std::string meshBytes_;          // what the binary chunk begins with
    std::uint64_t binaryBytes_ = 0;  // of the whole chunk
    std::map<std::size_t, std::optional<MeshAccessors>> meshData_;  // of meshes met so far
    std::map<MeshAndMaterial, std::size_t> meshes_;
    std::map<std::string, std::size_t> materials_;
    std::vector<std::size_t> nodeOfBody_, nodeOfCamera_;
};

/// glTF's cameras have one angle of view.
std::vector<std::string> GltfWriter::losses(const SceneDescription& scene) const
{
    std::vector<std::string> sentences;
    for (const SceneCamera& camera : scene.cameras) {
        const bool zooms = std::ranges::any_of(camera.keys, [&](const CameraKey& key) {
            return key.fovDegrees != camera.keys.front().fovDegrees;
        });
        if (!zooms) continue;
        sentences.push_back("the zoom of camera '" + camera.name +
                            "' is lost: a .glb holds one angle of view, that of the first frame; "
                            "a .abc or a .usda keeps it");
    }
    return sentences;
}

void GltfWriter::beginScene(const SceneDescription& scene, int firstFrame, int /*frameCount*/)
{
    scene_ = &scene;
    firstFrame_ = firstFrame;
    file_.emplace(output_);
    changes_.resize(scene.bodies.size());
    std::vector<std::size_t> moving;
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        if (scene.bodies[body].moves) moving.push_back(body);
    }
    motion_.emplace(file_->target().parent_path(), std::move(moving));
}

void GltfWriter::writeFrame(const SceneFrame& frame)
{
    // The format has no times below 0, and 0 is the first frame: if it were a sample before it,
    // every whole frame would come out between two frames of the reader's timeline.
    if (frame.frame + frame.offset < firstFrame_) return;
    if (firstPoses_.empty()) firstPoses_ = frame.worldFromAsset;
    for (const std::size_t body : motion_->bodies()) {
        const Pose &now = frame.worldFromAsset[body], &first = firstPoses_[body];
        Changes& changes = changes_[body];
        changes.translation = changes.translation || now.position != first.position;
        changes.rotation =
            changes.rotation || now.orientation.coeffs() != first.orientation.coeffs();
    }
    motion_->append(frame);
}

void GltfWriter::finishScene(const FinishWatch& watch)
{
    // Describe everything.
    json_["asset"] = {{"version", "2.0"}, {"generator", "Scree"}};
    json_["scene"] = 0;
    Json rootNodes = Json::array();
    addMaterials();
    addBodies(rootNodes);
    addCameras(rootNodes);
    json_["scenes"] = Json::array({{{"name", scene_->name}, {"nodes", rootNodes}}});
    addAnimation();
    if (binaryBytes_ > 0) json_["buffers"] = Json::array({{{"byteLength", binaryBytes_}}});

    // Write header, description and bytes.
    const std::string description = paddedTo4(json_.dump(), ' ');
    const std::uint64_t fileBytes =
        12 + 8 + description.size() + (binaryBytes_ > 0 ? 8 + binaryBytes_ : 0);
    if (fileBytes > std::numeric_limits<std::uint32_t>::max()) {
        throw Error(ErrorKind::badInput,
                    "cannot export to \"" + output_.string() + "\": it would need " +
                        std::to_string(fileBytes) +
                        " bytes and a .glb holds 4 GiB; export fewer frames, or to .abc");
    }
    std::string header;
    appendBytes(header, kMagic);
    appendBytes(header, kVersion);
    appendBytes(header, static_cast<std::uint32_t>(fileBytes));
    appendBytes(header, static_cast<std::uint32_t>(description.size()));
    appendBytes(header, kJsonChunk);
    file_->write(header + description);
    if (binaryBytes_ > 0) {
        std::string chunk;
        appendBytes(chunk, static_cast<std::uint32_t>(binaryBytes_));
        appendBytes(chunk, kBinaryChunk);
        file_->write(chunk + meshBytes_);
        writeMotion(watch);
    }
    SCREE_CHECK(file_->size() == fileBytes, "a .glb of another size than announced");
    motion_.reset();
    file_->commit();
}

/// Views follow each other in the binary chunk; all sizes are multiples of four.
std::size_t GltfWriter::addView(std::uint64_t byteCount, std::optional<int> target)
{
    Json view = {{"buffer", 0}, {"byteOffset", binaryBytes_}, {"byteLength", byteCount}};
    if (target) view["target"] = *target;
    binaryBytes_ += byteCount;
    json_["bufferViews"].push_back(view);
    return json_["bufferViews"].size() - 1;
}

std::size_t GltfWriter::addAccessor(std::size_t view, std::uint64_t offset, std::size_t count,
                                    const char* type, int componentType)
{
    json_["accessors"].push_back({{"bufferView", view},
                                  {"byteOffset", offset},
                                  {"componentType", componentType},
                                  {"count", count},
                                  {"type", type}});
    return json_["accessors"].size() - 1;
}

/// Nothing for a mesh without triangles: glTF has no empty ones.
std::optional<MeshAccessors> GltfWriter::addMeshData(const SceneMesh& mesh)
{
    const ShadedMesh shaded = shadeMesh(mesh);
    if (shaded.indices.empty()) return std::nullopt;
    std::vector<float> points, normals;
    Eigen::Vector3f lowest = shaded.points[0], highest = lowest;
    for (std::size_t i = 0; i < shaded.points.size(); ++i) {
        // A point whose faces all lack area has no normal; the format wants one.
        const Eigen::Vector3f& point = shaded.points[i];
        const bool hasNormal = shaded.normals[i].squaredNorm() > 0.5f;
        const Eigen::Vector3f normal = hasNormal ? shaded.normals[i] : Eigen::Vector3f::UnitY();
        points.insert(points.end(), point.begin(), point.end());
        normals.insert(normals.end(), normal.begin(), normal.end());
        lowest = lowest.cwiseMin(point);
        highest = highest.cwiseMax(point);
    }

    const std::size_t pointCount = shaded.points.size();
    const auto add = [&](std::string_view bytes, std::size_t count, const char* type, int component,
                         int target) {
        meshBytes_ += bytes;
        return addAccessor(addView(bytes.size(), target), 0, count, type, component);
    };
    MeshAccessors accessors;
    accessors.points = add(bytesOf(points), pointCount, "VEC3", kFloat, kVertexBuffer);
    accessors.normals = add(bytesOf(normals), pointCount, "VEC3", kFloat, kVertexBuffer);
    accessors.indices =
        add(bytesOf(shaded.indices), shaded.indices.size(), "SCALAR", kUnsignedInt, kIndexBuffer);
    if (!shaded.uvs.empty()) {
        std::vector<float> uvs;  // glTF's v grows downwards
        for (const Eigen::Vector2f& uv : shaded.uvs) uvs.insert(uvs.end(), {uv.x(), 1.0f - uv.y()});
        accessors.uvs = add(bytesOf(uvs), pointCount, "VEC2", kFloat, kVertexBuffer);
    }
    json_["accessors"][accessors.points]["min"] = jsonArray(lowest);
    json_["accessors"][accessors.points]["max"] = jsonArray(highest);
    return accessors;
}

std::optional<std::size_t> GltfWriter::addMesh(const SceneBody& body)
{
    const SceneMesh& mesh = scene_->meshes[body.mesh];
    const auto known = meshData_.find(body.mesh);
    const std::optional<MeshAccessors> data =
        known != meshData_.end() ? known->second
                                 : meshData_.emplace(body.mesh, addMeshData(mesh)).first->second;
    if (!data) return std::nullopt;
    const auto [entry, isNew] =
        meshes_.emplace(MeshAndMaterial(body.mesh, body.material), meshes_.size());
    if (!isNew) return entry->second;

    Json primitive = {{"attributes", {{"POSITION", data->points}, {"NORMAL", data->normals}}},
                      {"indices", data->indices}};
    if (data->uvs) primitive["attributes"]["TEXCOORD_0"] = *data->uvs;
    const auto material = materials_.find(body.material);
    if (material != materials_.end()) primitive["material"] = material->second;
    json_["meshes"].push_back({{"name", mesh.name}, {"primitives", Json::array({primitive})}});
    return entry->second;
}

void GltfWriter::addMaterials()
{
    for (const SceneMaterial& material : scene_->materials) {
        materials_.emplace(material.name, materials_.size());
        const Vec3 color = material.color.cwiseMax(0.0).cwiseMin(1.0);
        json_["materials"].push_back(
            {{"name", material.name},
             {"pbrMetallicRoughness",
              {{"baseColorFactor", {color.x(), color.y(), color.z(), 1.0}},
               {"metallicFactor", 0.0},
               {"roughnessFactor", std::clamp(material.roughness, 0.0, 1.0)}}}});
    }
}

void GltfWriter::addBodies(Json& rootNodes)
{
    std::vector<std::size_t> children;
    for (std::size_t b = 0; b < scene_->bodies.size(); ++b) {
        const SceneBody& body = scene_->bodies[b];
        const Pose& pose = firstPoses_[b];
        Json node = {{"name", body.name},
                     {"translation", jsonArray(pose.position.cast<float>().eval())},
                     {"rotation", jsonQuaternion(pose.orientation.normalized())},
                     {"extras", {{"bodyId", b}, {"mass", body.mass}, {"material", body.material}}}};
        const std::optional<std::size_t> mesh = body.isVisible ? addMesh(body) : std::nullopt;
        if (mesh) node["mesh"] = *mesh;
        children.push_back(json_["nodes"].size());
        json_["nodes"].push_back(node);
    }
    nodeOfBody_ = children;

    const double scale = scene_->metresPerUnit;
    Json root = {{"name", scene_->name},
                 {"rotation", jsonQuaternion(yUpFromShot(scene_->zUp))},
                 {"scale", {scale, scale, scale}}};
    if (!children.empty()) root["children"] = children;
    rootNodes.push_back(json_["nodes"].size());
    json_["nodes"].push_back(root);
}

void GltfWriter::addCameras(Json& rootNodes)
{
    const std::vector<std::string> names = cameraNames(*scene_);
    for (std::size_t k = 0; k < names.size(); ++k) {
        const SceneCamera camera = cameraAt(scene_->cameras[k], firstFrame_, scene_->zUp);
        const Pose pose = inYUpMetres(worldFromCamera(camera, scene_->zUp), *scene_);
        const double scale = scene_->metresPerUnit;
        const double distance = std::max((camera.eye - camera.target).norm() * scale, 1e-6);
        nodeOfCamera_.push_back(json_["nodes"].size());
        rootNodes.push_back(json_["nodes"].size());
        json_["nodes"].push_back({{"name", names[k]},
                                  {"camera", json_["cameras"].size()},
                                  {"translation", jsonArray(pose.position)},
                                  {"rotation", jsonQuaternion(pose.orientation)}});
        json_["cameras"].push_back({{"name", names[k]},
                                    {"type", "perspective"},
                                    {"perspective",
                                     {{"aspectRatio", scene_->aspect},
                                      {"yfov", camera.fovDegrees * kPi / 180.0},
                                      {"znear", 1e-3 * distance}}}});
    }
}

/// glTF 2.0 knows no visibility. A node of scale 0 is not drawn by any reader, so a body has none
/// until it is born; one that is never to be seen has no mesh.
void GltfWriter::addBirths(Json& samplers, Json& channels)
{
    const double end = motion_->times().back();
    for (std::size_t b = 0; b < scene_->bodies.size(); ++b) {
        const SceneBody& body = scene_->bodies[b];
        if (!body.isVisible || isSeen(body, firstFrame_)) continue;
        const int birthFrame = body.birthFrame;
        std::vector<float> seconds = {0.0f}, scales = {0.0f, 0.0f, 0.0f};
        if (birthFrame <= end) {
            seconds.push_back(static_cast<float>(secondsOf(birthFrame)));
            scales.insert(scales.end(), {1.0f, 1.0f, 1.0f});
        }
        const std::size_t input = addTimes(seconds);
        addChannel(samplers, channels, nodeOfBody_[b], "scale", "STEP", input,
                   addValues(scales, seconds.size(), "VEC3"));
    }
}

/// Where keyed cameras stand.
void GltfWriter::addCameraMotion(Json& samplers, Json& channels)
{
    const std::vector<double>& times = motion_->times();
    std::vector<float> seconds;
    for (const double time : times) seconds.push_back(static_cast<float>(secondsOf(time)));
    for (std::size_t k = 0; k < scene_->cameras.size(); ++k) {
        if (!moves(scene_->cameras[k])) continue;
        std::vector<float> places, turns;
        for (const Pose& seen :
             worldFromCameras(camerasAt(scene_->cameras[k], times, scene_->zUp), scene_->zUp)) {
            const Pose pose = inYUpMetres(seen, *scene_);
            for (const double value : pose.position) places.push_back(static_cast<float>(value));
            for (const double value : pose.orientation.coeffs())
                turns.push_back(static_cast<float>(value));
        }
        const std::size_t input = addTimes(seconds);
        addChannel(samplers, channels, nodeOfCamera_[k], "translation", "LINEAR", input,
                   addValues(places, seconds.size(), "VEC3"));
        addChannel(samplers, channels, nodeOfCamera_[k], "rotation", "LINEAR", input,
                   addValues(turns, seconds.size(), "VEC4"));
    }
}

/// These stand with the meshes' bytes, before all motion of bodies.
std::size_t GltfWriter::addValues(const std::vector<float>& values, std::size_t count,
                                  const char* type)
{
    meshBytes_ += bytesOf(values);
    const std::size_t view = addView(values.size() * sizeof(float), std::nullopt);
    return addAccessor(view, 0, count, type, kFloat);
}

/// Seconds, ascending; the format wants to know the first and the last.
std::size_t GltfWriter::addTimes(const std::vector<float>& times)
{
    const std::size_t input = addValues(times, times.size(), "SCALAR");
    json_["accessors"][input]["min"] = Json::array({static_cast<double>(times.front())});
    json_["accessors"][input]["max"] = Json::array({static_cast<double>(times.back())});
    return input;
}

void GltfWriter::addChannel(Json& samplers, Json& channels, std::size_t node, const char* path,
                            const char* interpolation, std::size_t input, std::size_t output)
{
    channels.push_back(
        {{"sampler", samplers.size()}, {"target", {{"node", node}, {"path", path}}}});
    samplers.push_back({{"input", input}, {"interpolation", interpolation}, {"output", output}});
}

/// Views: the times, then all translations, then all rotations that change.
void GltfWriter::addAnimation()
{
    std::size_t translationCount = 0, rotationCount = 0;
    for (const Changes& changes : changes_) {
        translationCount += changes.translation;
        rotationCount += changes.rotation;
    }
    Json samplers = Json::array(), channels = Json::array();
    addBirths(samplers, channels);
    addCameraMotion(samplers, channels);
    if (translationCount + rotationCount + channels.size() == 0) return;

    const std::size_t count = motion_->times().size();
    const std::size_t timeAccessor =
        addAccessor(addView(count * sizeof(float), std::nullopt), 0, count, "SCALAR", kFloat);
    const double last = secondsOf(motion_->times().back());
    json_["accessors"][timeAccessor]["min"] = Json::array({0.0});
    json_["accessors"][timeAccessor]["max"] =
        Json::array({static_cast<double>(static_cast<float>(last))});

    const auto addTracks = [&](bool Changes::*changes, std::size_t trackCount, const char* path,
                               const char* type, std::uint64_t sampleBytes) {
        if (trackCount == 0) return;
        const std::uint64_t trackBytes = count * sampleBytes;
        const std::size_t view = addView(trackCount * trackBytes, std::nullopt);
        std::uint64_t offset = 0;
        for (const std::size_t body : motion_->bodies()) {
            if (!(changes_[body].*changes)) continue;
            const std::size_t output = addAccessor(view, offset, count, type, kFloat);
            offset += trackBytes;
            addChannel(samplers, channels, nodeOfBody_[body], path, "LINEAR", timeAccessor, output);
        }
    };
    addTracks(&Changes::translation, translationCount, "translation", "VEC3", kTranslationBytes);
    addTracks(&Changes::rotation, rotationCount, "rotation", "VEC4", kRotationBytes);
    json_["animations"] = Json::array(
        {{{"name", scene_->name},
          {"channels", channels},
          {"samplers", samplers},
          {"extras",
           {{"firstFrame", firstFrame_}, {"framesPerSecond", scene_->framesPerSecond}}}}});
}

void GltfWriter::writeMotion(const FinishWatch& watch)
{
    if (!json_.contains("animations")) return;
    std::string bytes;
    for (const double time : motion_->times())
        appendBytes(bytes, static_cast<float>(secondsOf(time)));
    file_->write(bytes);

    const auto count = static_cast<double>(motion_->bodies().size());
    const auto writeTracks = [&](double before, bool Changes::*changes, auto valuesOf) {
        motion_->visitTracks([&](std::size_t k, std::span<const MotionSample> track) {
            watch(before + 0.5 * static_cast<double>(k) / count);
            if (!(changes_[motion_->bodies()[k]].*changes)) return;
            bytes.clear();
            for (const MotionSample& sample : track) bytes += bytesOf(valuesOf(sample));
            file_->write(bytes);
        });
    };
    writeTracks(0.0, &Changes::translation, [](const MotionSample& sample) -> Eigen::Vector3f {
        return sample.worldFromAsset.position.cast<float>();
    });
    writeTracks(0.5, &Changes::rotation, [](const MotionSample& sample) -> Eigen::Vector4f {
        return sample.worldFromAsset.orientation.coeffs().cast<float>();
    });
}

}  // namespace

std::unique_ptr<FrameWriter> makeGltfWriter(const fs::path& output)
{
    return std::make_unique<GltfWriter>(output);
}

}  // namespace scree
