#include "io/usd_stage.h"

#include <cmath>

#include "core/math/rotation.h"
#include "core/picture/shaded_mesh.h"
#include "io/camera_names.h"
#include "io/camera_pose.h"
#include "io/motion_spool.h"
#include "io/unique_names.h"

namespace scree {

namespace {

// Film back that cameras get [mm]; only its ratio to the focal length shows in the picture.
constexpr double kApertureHeight = 24.0;

// What a camera clips, as multiples of the distance to its target.
constexpr double kNearest = 1e-3, kFarthest = 1e4;

std::string usdPath(const std::string& path)
{
    return "<" + path + ">";
}

std::string schemas(const std::vector<std::string>& names)
{
    const auto append = [](std::string& text, const std::string& name) {
        text += '"' + name + '"';
    };
    return "prepend apiSchemas = " + usdArray(names, append);
}

void appendFloatTuple(std::string& text, const Eigen::Vector3f& vector)
{
    appendUsdTuple(text, vector);
}

std::string colorText(const Vec3& color)
{
    return usdTuple(color.cast<float>().eval());
}

void writeMaterial(UsdText& text, const std::string& name, const std::string& path,
                   const SceneMaterial& material, double metresPerUnit)
{
    text.openPrim(usdPrim("Material", name), {schemas({"PhysicsMaterialAPI"})});
    const auto number = [&](const char* attribute, double value) {
        text.line("float " + std::string(attribute) + " = " +
                  numberText(static_cast<float>(value)));
    };
    number("physics:density", material.density * metresPerUnit * metresPerUnit * metresPerUnit);
    number("physics:dynamicFriction", material.friction);
    number("physics:restitution", material.restitution);
    number("physics:staticFriction", material.friction);
    writeUsdOldName(text, material.name, name);
    text.line("token outputs:surface.connect = " + usdPath(path + "/Surface.outputs:surface"));
    text.openPrim(usdPrim("Shader", "Surface"));
    text.line("uniform token info:id = \"UsdPreviewSurface\"");
    text.line("color3f inputs:diffuseColor = " + colorText(material.color));
    text.line("float inputs:metallic = 0");
    number("inputs:roughness", material.roughness);
    text.line("token outputs:surface");
    text.closePrim();
    text.closePrim();
}

void writeMesh(UsdText& text, const std::string& name, const SceneMesh& mesh)
{
    // Readers get the artist's points and triangles; only normals come from the shaded mesh.
    const Eigen::Matrix3Xf normals = cornerNormals(mesh);
    const Eigen::Matrix3Xf points = mesh.points.cast<float>();

    text.openPrim(usdPrim("Xform", name));
    writeUsdOldName(text, mesh.name, name);
    text.openPrim(usdPrim("Mesh", "Geo"),
                  {schemas({"PhysicsCollisionAPI", "PhysicsMeshCollisionAPI"})});
    if (points.cols() > 0) {
        const std::vector<Eigen::Vector3f> extent = {points.rowwise().minCoeff(),
                                                     points.rowwise().maxCoeff()};
        text.line("float3[] extent = " + usdArray(extent, appendFloatTuple));
    }
    const std::vector<int> counts(static_cast<std::size_t>(mesh.triangles.cols()), 3);
    text.line("int[] faceVertexCounts = " + usdArray(counts, appendNumber<int>));
    text.line("int[] faceVertexIndices = " +
              usdArray(mesh.triangles.reshaped(), appendNumber<int>));
    if (normals.cols() > 0) {
        const auto append = [](std::string& line, const Eigen::Vector3f& normal) {
            appendUsdTuple(line, normal);
        };
        text.line("normal3f[] normals = " + usdArray(normals.colwise(), append) + " (");
        text.line("    interpolation = \"faceVarying\"");
        text.line(")");
    }
    text.line("uniform token orientation = \"rightHanded\"");
    text.line("uniform token physics:approximation = \"none\"");
    text.line("point3f[] points = " + usdArray(points.colwise(), appendFloatTuple));
    if (mesh.cornerUvs.cols() > 0) {
        const auto append = [](std::string& line, const Eigen::Vector2f& uv) {
            appendUsdTuple(line, uv);
        };
        text.line("texCoord2f[] primvars:st = " + usdArray(mesh.cornerUvs.colwise(), append) +
                  " (");
        text.line("    interpolation = \"faceVarying\"");
        text.line(")");
    }
    text.line("uniform token subdivisionScheme = \"none\"");
    text.closePrim();
    text.closePrim();
}

std::string floatText(double value)
{
    return numberText(static_cast<float>(value));
}

double targetDistance(const SceneCamera& camera)
{
    return std::max((camera.eye - camera.target).norm(), 1e-6);
}

std::string clippingText(const SceneCamera& camera)
{
    const double distance = targetDistance(camera);
    return usdTuple(
        Eigen::Vector2d(kNearest * distance, kFarthest * distance).cast<float>().eval());
}

std::string focalText(const SceneCamera& camera)
{
    return floatText(0.5 * kApertureHeight / std::tan(camera.fovDegrees * kPi / 360.0));
}

std::string focusText(const SceneCamera& camera)
{
    return floatText(targetDistance(camera));
}

void writeCamera(UsdText& text, const std::string& name, const SceneDescription& scene,
                 const SceneCamera& camera, const std::vector<double>& times)
{
    const std::vector<SceneCamera> samples = camerasAt(camera, times, scene.zUp);
    const auto track = [&](const char* attribute, const auto& items, const auto& textOf) {
        std::vector<std::string> values;
        for (const auto& item : items) values.push_back(textOf(item));
        writeUsdTrack(text, attribute, times, values);
    };
    text.openPrim(usdPrim("Camera", name));
    track("float2 clippingRange", samples, clippingText);
    track("float focalLength", samples, focalText);
    track("float focusDistance", samples, focusText);
    text.line("float horizontalAperture = " + floatText(kApertureHeight * scene.aspect));
    text.line("token projection = \"perspective\"");
    text.line("float verticalAperture = " + floatText(kApertureHeight));
    writeUsdOldName(text, camera.name, name);
    const std::vector<Pose> poses = worldFromCameras(samples, scene.zUp);
    track("quatd xformOp:orient", poses,
          [](const Pose& pose) { return usdTuple(usdQuaternion(pose.orientation)); });
    track("double3 xformOp:translate", poses,
          [](const Pose& pose) { return usdTuple(pose.position); });
    text.line("uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]");
    text.closePrim();
}

}  // namespace

UsdNames::UsdNames(const SceneDescription& scene) : root(UniqueNames().take(scene.name))
{
    // Names that need no change go first, so that none of them has to give way to a changed one.
    UniqueNames children;
    bodies.resize(scene.bodies.size());
    for (const bool isPlain : {true, false}) {
        for (std::size_t body = 0; body < bodies.size(); ++body) {
            const std::string& name = scene.bodies[body].name;
            if (isPlainName(name) == isPlain) bodies[body] = children.take(name);
        }
    }
    meshScope = children.take("Prototypes");
    materialScope = children.take("Materials");
    instancer = children.take("Bodies");
    for (const std::string& name : cameraNames(scene)) cameras.push_back(children.take(name));

    UniqueNames meshNames, materialNames;
    for (const SceneMesh& mesh : scene.meshes) meshes.push_back(meshNames.take(mesh.name));
    for (const SceneMaterial& material : scene.materials) {
        materialIndex.emplace(material.name, materials.size());
        materials.push_back(materialNames.take(material.name));
    }
}

std::string UsdNames::meshPath(std::size_t mesh) const
{
    return "/" + root + "/" + meshScope + "/" + meshes[mesh];
}

std::string UsdNames::materialPath(const std::string& material) const
{
    const auto index = materialIndex.find(material);
    if (index == materialIndex.end()) return "";
    return "/" + root + "/" + materialScope + "/" + materials[index->second];
}

void writeUsdHeader(AtomicFile& file, const UsdNames& names, const SceneDescription& scene,
                    double firstTime, double lastTime)
{
    std::string text = "#usda 1.0\n(\n";
    const auto entry = [&](const char* key, const std::string& value) {
        text += "    " + std::string(key) + " = " + value + "\n";
    };
    entry("defaultPrim", usdString(names.root));
    entry("endTimeCode", numberText(lastTime));
    entry("framesPerSecond", numberText(scene.framesPerSecond));
    entry("kilogramsPerUnit", "1");
    entry("metersPerUnit", numberText(scene.metresPerUnit));
    entry("startTimeCode", numberText(firstTime));
    entry("timeCodesPerSecond", numberText(scene.framesPerSecond));
    entry("upAxis", scene.zUp ? "\"Z\"" : "\"Y\"");
    file.write(text + ")\n\n");
}

void writeUsdMaterials(UsdText& text, const UsdNames& names, const SceneDescription& scene)
{
    if (scene.materials.empty()) return;
    text.openPrim(usdPrim("Scope", names.materialScope));
    for (std::size_t k = 0; k < scene.materials.size(); ++k) {
        const std::string path =
            "/" + names.root + "/" + names.materialScope + "/" + names.materials[k];
        writeMaterial(text, names.materials[k], path, scene.materials[k], scene.metresPerUnit);
    }
    text.closePrim();
}

void writeUsdMeshes(UsdText& text, const UsdNames& names, const SceneDescription& scene)
{
    std::vector<bool> isUsed(scene.meshes.size(), false);
    for (const SceneBody& body : scene.bodies) isUsed[body.mesh] = true;

    text.openPrim("class Scope \"" + names.meshScope + "\"");
    for (std::size_t mesh = 0; mesh < isUsed.size(); ++mesh) {
        if (isUsed[mesh]) writeMesh(text, names.meshes[mesh], scene.meshes[mesh]);
    }
    text.closePrim();
}

void writeUsdCameras(UsdText& text, const UsdNames& names, const SceneDescription& scene,
                     const std::vector<double>& times)
{
    for (std::size_t k = 0; k < scene.cameras.size(); ++k) {
        writeCamera(text, names.cameras[k], scene, scene.cameras[k], times);
    }
}

void writeUsdTrack(UsdText& text, const std::string& attribute, const std::vector<double>& times,
                   const std::vector<std::string>& values)
{
    const std::vector<std::size_t> needed = neededTimes(
        values.size(), [&](std::size_t i, std::size_t j) { return values[i] == values[j]; });
    if (needed.size() == 1) {
        text.line(attribute + " = " + values[0]);
        return;
    }
    text.openTimes(attribute);
    for (const std::size_t i : needed) text.time(times[i], values[i]);
    text.closeTimes();
}

std::vector<std::string> usdBodyMetadata(const UsdNames& names, const SceneBody& body,
                                         bool isInstance)
{
    std::vector<std::string> applied;
    if (!names.materialPath(body.material).empty()) applied.push_back("MaterialBindingAPI");
    if (body.moves) applied.push_back("PhysicsRigidBodyAPI");
    if (body.moves && body.mass > 0.0) applied.push_back("PhysicsMassAPI");

    std::vector<std::string> metadata;
    if (isInstance) metadata.push_back("instanceable = true");
    if (!applied.empty()) metadata.push_back(schemas(applied));
    metadata.push_back("prepend references = " + usdPath(names.meshPath(body.mesh)));
    return metadata;
}

void writeUsdBodyProperties(UsdText& text, const UsdNames& names, const SceneDescription& scene,
                            const SceneBody& body)
{
    const auto material = names.materialIndex.find(body.material);
    if (material != names.materialIndex.end()) {
        text.line("rel material:binding = " + usdPath(names.materialPath(body.material)));
    }
    if (body.moves) {
        text.line("bool physics:kinematicEnabled = true");
        if (body.mass > 0.0) {
            text.line("float physics:mass = " + numberText(static_cast<float>(body.mass)));
        }
        text.line("bool physics:rigidBodyEnabled = true");
    }
    if (material != names.materialIndex.end()) {
        text.line("color3f[] primvars:displayColor = [" +
                  colorText(scene.materials[material->second].color) + "] (");
        text.line("    interpolation = \"constant\"");
        text.line(")");
    }
    if (!body.material.empty()) {
        text.line("custom string userProperties:material = " + usdString(body.material));
    }
}

void writeUsdOldName(UsdText& text, const std::string& wanted, const std::string& name)
{
    if (wanted != name) text.line("custom string userProperties:name = " + usdString(wanted));
}

}  // namespace scree
