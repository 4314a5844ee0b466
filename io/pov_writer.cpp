#include "io/pov_writer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/math/rotation.h"
#include "core/picture/camera_motion.h"
#include "core/picture/preview_light.h"
#include "core/picture/shaded_mesh.h"
#include "io/atomic_file.h"
#include "io/camera_pose.h"
#include "io/frame_pattern.h"
#include "io/number_text.h"

namespace scree {

namespace {

namespace fs = std::filesystem;

// POV-Ray's ambient light does not know up from down: the mean of both.
const Vec3 kAmbient = 0.5 * (kSkyLight + kGroundLight);

template <class Vector>
std::string povVector(const Vector& vector)
{
    std::string text;
    char before = '<';
    for (const auto coordinate : vector) {
        text += before;
        appendNumber(text, coordinate);
        before = ',';
    }
    return text += '>';
}

/// A material's name may hold anything, so objects are known by numbers and names are comments.
std::string inComment(const std::string& name)
{
    std::string text = name;
    std::replace_if(
        text.begin(), text.end(), [](unsigned char letter) { return letter < ' '; }, ' ');
    return " // " + text + "\n";
}

class PovWriter final : public FrameWriter {
public:
    explicit PovWriter(fs::path output) : output_(std::move(output)) {}

private:
    void beginScene(const SceneDescription& scene, int firstFrame, int frameCount) override;
    void writeFrame(const SceneFrame& frame) override;
    void finishScene(const FinishWatch& /*watch*/) override {}

    fs::path includeFile() const;
    void writeInclude();
    bool writeMesh(AtomicFile& file, std::size_t mesh) const;
    std::string materialsText() const;
    std::string lightText() const;
    std::string cameraText() const;
    std::string bodyText(std::size_t body, const Pose& worldFromAsset) const;

    fs::path output_;
    const SceneDescription* scene_ = nullptr;
    std::optional<SceneCamera> camera_;
    std::vector<bool> isDrawn_;  // parallel to meshes: a body uses it, and it has triangles
    std::map<std::string, std::size_t> materials_;
};

void PovWriter::beginScene(const SceneDescription& scene, int firstFrame, int /*frameCount*/)
{
    scene_ = &scene;
    isDrawn_.assign(scene.meshes.size(), false);
    for (const SceneBody& body : scene.bodies) isDrawn_[body.mesh] = true;
    for (const SceneMaterial& material : scene.materials) {
        materials_.emplace(material.name, materials_.size());
    }
    const AtomicFile probe(framePath(output_.string(), firstFrame));
    removeAbandoned(includeFile());
    writeInclude();
}

/// heap.####.pov → heap_meshes.inc. Each other pattern has a name of its own, with @ for the
/// number: what is written beside an export must not change what that shows. heap.pov →
/// heap.pov_meshes.inc
fs::path PovWriter::includeFile() const
{
    const std::string stem = output_.stem().string();
    if (!hasFramePattern(stem)) return output_.string() + "_meshes.inc";
    auto [head, tail, digits] = splitFramePattern(stem);
    const bool isUsual = head.size() > 1 && head.ends_with('.') && tail.empty();
    if (isUsual) head.pop_back();
    return output_.parent_path() / (head + (isUsual ? "" : "@") + tail + "_meshes.inc");
}

void PovWriter::writeInclude()
{
    AtomicFile file(includeFile());
    file.write("// Meshes and materials of " + scene_->name + ", for POV-Ray 3.7 or later.\n");
    file.write(materialsText());
    for (std::size_t mesh = 0; mesh < isDrawn_.size(); ++mesh) {
        if (isDrawn_[mesh]) isDrawn_[mesh] = writeMesh(file, mesh);
    }
    file.commit();
}

std::string PovWriter::materialsText() const
{
    const auto declaration = [](const std::string& name, const SceneMaterial& material) {
        const double roughness = std::clamp(material.roughness, 0.0, 1.0);
        std::string text = "#declare Material_" + name + " = texture {";
        text += inComment(material.name);
        text += "    pigment { color rgb " + povVector(material.color) + " }\n";
        text += "    finish { ambient 1 diffuse 0.85 specular " +
                numberText(0.3 * (1.0 - roughness)) + " roughness " +
                numberText(std::max(roughness * roughness * 0.25, 0.001)) + " }\n}\n";
        return text;
    };
    SceneMaterial plain;
    plain.name = "for bodies whose material is not known";
    std::string text = declaration("plain", plain);
    for (const auto& [name, index] : materials_) {
        text += declaration(std::to_string(index), scene_->materials[index]);
    }
    return text;
}

/// False for a mesh without triangles: POV-Ray has no empty ones.
bool PovWriter::writeMesh(AtomicFile& file, std::size_t mesh) const
{
    ShadedMesh shaded = shadeMesh(scene_->meshes[mesh]);
    if (shaded.indices.empty()) return false;
    for (Eigen::Vector3f& normal : shaded.normals) {
        if (normal.isZero(0.0f)) normal = Eigen::Vector3f::UnitY();  // its faces have no area
    }
    const auto writeVectors = [&](const char* keyword, const auto& vectors) {
        std::string text = "    " + std::string(keyword) + " { " + std::to_string(vectors.size());
        for (const auto& vector : vectors) text += ",\n        " + povVector(vector);
        file.write(text + "\n    }\n");
    };
    file.write("#declare Mesh_" + std::to_string(mesh) + " = mesh2 {" +
               inComment(scene_->meshes[mesh].name));
    writeVectors("vertex_vectors", shaded.points);
    writeVectors("normal_vectors", shaded.normals);
    if (!shaded.uvs.empty()) writeVectors("uv_vectors", shaded.uvs);

    std::string faces = "    face_indices { " + std::to_string(shaded.indices.size() / 3);
    for (std::size_t i = 0; i < shaded.indices.size(); i += 3) {
        faces += ",\n        <" + std::to_string(shaded.indices[i]) + "," +
                 std::to_string(shaded.indices[i + 1]) + "," +
                 std::to_string(shaded.indices[i + 2]) + ">";
    }
    file.write(faces + "\n    }\n}\n");
    return true;
}

void PovWriter::writeFrame(const SceneFrame& frame)
{
    if (!scene_->cameras.empty())
        camera_ = cameraAt(scene_->cameras.front(), frame.frame, scene_->zUp);
    else if (!camera_)
        camera_ = cameraOfAll(*scene_, frame);

    AtomicFile file(framePath(output_.string(), frame.frame));
    const std::string include = includeFile().filename().string();
    file.write("// " + scene_->name + ", frame " + std::to_string(frame.frame) +
               ". Render in this folder: it holds " + include + ".\n#version 3.7;\n");
    file.write("global_settings { assumed_gamma 1 ambient_light rgb " + povVector(kAmbient) +
               " }\n#include \"" + include + "\"\n");
    file.write(cameraText());
    file.write(lightText());
    for (std::size_t body = 0; body < scene_->bodies.size(); ++body) {
        if (isDrawn_[scene_->bodies[body].mesh] && isSeen(scene_->bodies[body], frame.frame)) {
            file.write(bodyText(body, frame.worldFromAsset[body]));
        }
    }
    file.commit();
}

// The ray through a point of the picture is direction + u right + v up with u and v in −½ … ½.
// Written out, these vectors leave nothing to POV-Ray's own idea of handedness.
std::string PovWriter::cameraText() const
{
    const Mat3 axes = worldFromCamera(*camera_, scene_->zUp).orientation.toRotationMatrix();
    const double distance = 0.5 / std::tan(camera_->fovDegrees * kPi / 360.0);
    const Vec3 direction = -distance * axes.col(2), right = scene_->aspect * axes.col(0);
    const Vec3 up = axes.col(1);
    return "camera {" +
           inComment(camera_->name + "; pictures " + numberText(scene_->aspect) +
                     " times as wide as high") +
           "    perspective\n    location " + povVector(camera_->eye) + "\n    direction " +
           povVector(direction) + "\n    right " + povVector(right) + "\n    up " + povVector(up) +
           "\n}\n";
}

std::string PovWriter::lightText() const
{
    const Vec3 sun =
        scene_->zUp ? Vec3(kTowardSun.x(), -kTowardSun.z(), kTowardSun.y()) : kTowardSun;
    const Vec3 up = scene_->zUp ? Vec3::UnitZ() : Vec3::UnitY();
    const double far = 1e4 * std::max((camera_->eye - camera_->target).norm(), 1e-6);
    const Vec3 place = camera_->target + far * sun.normalized();

    // The gradient runs from the nadir through the horizon, which is half way, to the zenith. In
    // between are the preview's exponentials, close to the horizon, as a few straight pieces.
    std::string colors;
    for (const double height : {-1.0, -0.5, -0.25, -0.1, 0.0, 0.1, 0.25, 0.5, 1.0}) {
        const double share = std::exp(-3.2 * std::abs(height));
        const Vec3 color =
            share * kHorizonColor + (1.0 - share) * (height > 0.0 ? kZenithColor : kNadirColor);
        colors += "            [" + numberText(0.5 + 0.5 * height) + " color rgb " +
                  povVector(color.cast<float>().eval()) + "]\n";
    }
    return "light_source {\n    " + povVector(place) + ", color rgb " + povVector(kSunLight) +
           "\n    parallel point_at " + povVector(camera_->target) +
           "\n}\nsky_sphere {\n    pigment {\n        gradient " + povVector(up) +
           "\n        color_map {\n" + colors + "        }\n        scale 2 translate " +
           povVector((-up).eval()) + "\n    }\n}\n";
}

std::string PovWriter::bodyText(std::size_t body, const Pose& worldFromAsset) const
{
    const SceneBody& b = scene_->bodies[body];
    const auto material = materials_.find(b.material);
    const std::string texture =
        material == materials_.end() ? "plain" : std::to_string(material->second);

    // Images of the three axes, then the place of the origin.
    std::string matrix;
    const Mat3 rotation = worldFromAsset.orientation.toRotationMatrix();
    for (const double entry : rotation.reshaped()) appendNumber(matrix, entry), matrix += ',';
    for (const double entry : worldFromAsset.position) appendNumber(matrix, entry), matrix += ',';
    matrix.pop_back();
    return "object { Mesh_" + std::to_string(b.mesh) + " texture { Material_" + texture +
           " } matrix <" + matrix + "> } // " + b.name + "\n";
}

}  // namespace

std::unique_ptr<FrameWriter> makePovWriter(const fs::path& output)
{
    return std::make_unique<PovWriter>(output);
}

}  // namespace scree
