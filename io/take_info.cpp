#include "io/take_info.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/check.h"
#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/picture/camera_motion.h"
#include "io/file_bytes.h"
#include "io/mesh_import.h"
#include "io/shot_schema.h"
#include "io/subframes.h"
#include "io/text_forms.h"

namespace scree {
namespace {

using Json = nlohmann::ordered_json;

std::uint64_t fromHex(const std::string& text)
{
    std::uint64_t value = 0;
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value, 16);
    if (result.ec != std::errc() || result.ptr != text.data() + text.size())
        throw std::runtime_error("\"" + text + "\" is not a hexadecimal number");
    return value;
}

void require(bool isRight, const std::string& key, const Json& json, const std::string& expected)
{
    if (isRight) return;
    throw std::runtime_error("\"" + key + "\" is " + json.dump() + ", expected " + expected);
}

/// A number that the shot's key `path` has given: what the shot may not say, a take cannot hold.
template <class Number>
Number numberFrom(const Json& json, const char* path)
{
    const ShotKey& key = *findShotKey(path);
    const auto value = json.get<double>();
    const bool isInside =
        key.isOpen ? value > key.min && value < key.max : value >= key.min && value <= key.max;
    const bool isWhole = !std::is_integral_v<Number> || value == std::floor(value);
    require(isInside && isWhole, path, json, "what a shot may say there");
    return static_cast<Number>(value);
}

int frameFrom(const Json& json)
{
    constexpr double kFarthest = std::numeric_limits<int>::max();
    const auto value = json.get<double>();
    require(std::abs(value) <= kFarthest && value == std::floor(value), "frames", json,
            "whole numbers");
    return static_cast<int>(value);
}

/// Files are named after shots and shapes: what leads out of the take is no name.
std::string nameFrom(const Json& json)
{
    const std::string name = json;
    const bool isName = !name.empty() && name.front() != '.' &&
                        name.find('/') == std::string::npos && name.find('\0') == std::string::npos;
    require(isName, "name", json, "one that a file may have");
    return name;
}

const char* motionWord(BodyKind kind)
{
    switch (kind) {
        case BodyKind::dynamic:
            return "dynamic";
        case BodyKind::keyed:
            return "keyed";
        case BodyKind::fixed:
            break;
    }
    return "static";
}

Json toJson(const TakeBody& body)
{
    Json json = {{"name", body.name}, {body.isPlane ? "plane" : "shape", body.shape}};
    json["material"] = body.material;
    json["motion"] = motionWord(body.kind);
    json["mass"] = body.mass;
    if (!body.isVisible) json["visible"] = false;
    return json;
}

BodyKind kindFrom(const Json& json)
{
    for (const BodyKind kind : {BodyKind::dynamic, BodyKind::keyed, BodyKind::fixed}) {
        if (json == motionWord(kind)) return kind;
    }
    require(false, "motion", json, "dynamic, keyed or static");
    return BodyKind::fixed;
}

TakeBody bodyFromJson(const Json& json)
{
    TakeBody body;
    body.name = json.at("name");
    body.isPlane = json.contains("plane");
    body.shape = json.at(body.isPlane ? "plane" : "shape");
    body.material = json.at("material");
    body.kind = kindFrom(json.at("motion"));
    body.mass = json.at("mass");
    require(body.mass >= 0.0, "mass", json.at("mass"), "no less than nothing");
    body.isVisible = json.value("visible", true);
    return body;
}

Json toJson(const Vec3& v)
{
    return {v.x(), v.y(), v.z()};
}

Vec3 vectorFromJson(const Json& json)
{
    return Vec3(json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>());
}

Json toJson(const SceneMaterial& look)
{
    return {{"material", look.name},       {"color", toJson(look.color)},
            {"roughness", look.roughness}, {"density", look.density},
            {"friction", look.friction},   {"restitution", look.restitution}};
}

/// Cameras that stand as the scene does say nothing of it.
void addUp(const Vec3& up, Json& json)
{
    if (!up.isZero(0.0)) json["up"] = toJson(up);
}

Vec3 upFromJson(const Json& json)
{
    return json.contains("up") ? vectorFromJson(json.at("up")) : Vec3(Vec3::Zero());
}

Json toJson(const CameraKey& key)
{
    Json json = {{"frame", key.frame},
                 {"eye", toJson(key.eye)},
                 {"target", toJson(key.target)},
                 {"fov", key.fovDegrees}};
    addUp(key.up, json);
    return json;
}

CameraKey keyFromJson(const Json& json)
{
    return {json.at("frame"), vectorFromJson(json.at("eye")), vectorFromJson(json.at("target")),
            numberFrom<double>(json.at("fov"), "camera.keys.fov"), upFromJson(json)};
}

Json toJson(const CameraOrbit& orbit)
{
    return {{"centre", toJson(orbit.centre)}, {"radius", orbit.radius},
            {"height", orbit.height},         {"start", orbit.startDegrees},
            {"degrees", orbit.degrees},       {"frames", {orbit.firstFrame, orbit.lastFrame}}};
}

CameraOrbit orbitFromJson(const Json& json)
{
    return {vectorFromJson(json.at("centre")),
            numberFrom<double>(json.at("radius"), "camera.orbit.radius"),
            json.at("height"),
            json.at("start"),
            json.at("degrees"),
            json.at("frames").at(0),
            json.at("frames").at(1)};
}

Json toJson(const SceneCamera& camera);

template <class T>
Json listToJson(const std::vector<T>& items)
{
    Json list = Json::array();
    for (const T& item : items) list.push_back(toJson(item));
    return list;
}

/// `eye` and `target` of a camera that moves are those of the shot's first frame.
Json toJson(const SceneCamera& camera)
{
    Json json = {{"name", camera.name},
                 {"eye", toJson(camera.eye)},
                 {"target", toJson(camera.target)},
                 {"fov", camera.fovDegrees}};
    addUp(camera.up, json);
    if (!camera.keys.empty()) {
        json["keys"] = listToJson(camera.keys);
        json["interpolate"] = camera.isSmooth ? "smooth" : "linear";
    }
    if (camera.orbit) json["orbit"] = toJson(*camera.orbit);
    return json;
}

SceneCamera cameraFromJson(const Json& json)
{
    SceneCamera camera;
    camera.name = json.at("name");
    camera.eye = vectorFromJson(json.at("eye"));
    camera.target = vectorFromJson(json.at("target"));
    camera.fovDegrees = numberFrom<double>(json.at("fov"), "camera.fov");
    camera.up = upFromJson(json);
    if (json.contains("keys")) {
        for (const Json& key : json.at("keys")) camera.keys.push_back(keyFromJson(key));
        camera.isSmooth = json.at("interpolate") == "smooth";
    }
    if (json.contains("orbit")) camera.orbit = orbitFromJson(json.at("orbit"));
    return camera;
}

Vec3 colorFrom(const Json& json)
{
    Vec3 color;
    for (const int k : {0, 1, 2}) color[k] = numberFrom<double>(json.at(k), "material.color");
    return color;
}

void readPictures(const Json& json, TakeInfo& info)
{
    for (const Json& look : json.at("looks"))
        info.materials.push_back({look.at("material"), colorFrom(look.at("color")),
                                  numberFrom<double>(look.at("roughness"), "material.roughness"),
                                  look.value("density", 0.0), look.value("friction", 0.0),
                                  look.value("restitution", 0.0)});
    for (const Json& camera : json.at("cameras")) info.cameras.push_back(cameraFromJson(camera));
    for (const std::size_t k : {0, 1}) {
        info.pictureSize[k] = numberFrom<int>(json.at("picture_size").at(k), "render.size");
    }
    info.burnIn = json.value("burnin", true);
    info.motionBlur = numberFrom<int>(json.value("motion_blur", Json(1)), "render.motion_blur");
}

void describePictures(const Shot& shot, TakeInfo& info)
{
    for (const ShotMaterial& material : shot.materials)
        info.materials.push_back({material.material.name, material.color, material.roughness,
                                  material.material.density, material.material.friction,
                                  material.material.restitution});
    for (const SceneCamera& camera : shot.cameras)
        info.cameras.push_back(scaled(camera, 1.0 / shot.metresPerUnit));
    info.pictureSize = shot.render.size;
    info.burnIn = shot.render.burnIn;
    info.motionBlur = shot.render.motionBlur;
}

/// Each file once: those of the shapes in the order of the shot, which older takes have alone, then
/// all others.
std::vector<TakeInput> hashInputs(const Shot& shot)
{
    std::vector<std::string> files;
    std::set<std::string> known;
    const auto add = [&](const std::string& path) {
        if (!path.empty() && known.insert(path).second) files.push_back(path);
    };
    for (const ShotShape& shape : shot.shapes) {
        const auto* file = std::get_if<FileSpec>(&shape.source);
        const auto* node = std::get_if<NodeSpec>(&shape.source);
        add(file ? file->path : node ? node->path : "");
        add(shape.collision ? shape.collision->path : "");
    }
    for (const std::string& path : shot.sideFiles) add(path);
    const std::vector<std::string> assets = files;
    for (const std::string& path : assets)
        for (const std::string& part : partsOfAsset(path)) add(part);
    std::vector<TakeInput> inputs;
    for (const std::string& path : files) inputs.push_back({path, hashText(readFileBytes(path))});
    return inputs;
}

TakeInfo infoFromJson(const Json& json)
{
    TakeInfo info;
    info.programVersion = json.at("program_version");
    info.name = nameFrom(json.at("name"));
    info.framesPerSecond = numberFrom<double>(json.at("fps"), "shot.fps");
    info.firstFrame = frameFrom(json.at("frames").at(0));
    info.lastFrame = frameFrom(json.at("frames").at(1));
    require(info.firstFrame <= info.lastFrame, "frames", json.at("frames"), "the first first");
    info.metresPerUnit = json.at("metres_per_unit");
    require(info.metresPerUnit > 0.0, "metres_per_unit", json.at("metres_per_unit"),
            "more than nothing");
    info.zUp = json.at("up") == "+z";
    require(info.zUp || json.at("up") == "+y", "up", json.at("up"), "+y or +z");
    info.seed = json.at("seed");
    info.shotHash = fromHex(json.at("shot_hash"));
    if (json.contains("branch")) {
        info.branchTake = json.at("branch").at("take");
        info.branchFrame = frameFrom(json.at("branch").at("frame"));
        info.branchHash = fromHex(json.at("branch").value("hash", "0"));
    }
    for (const Json& input : json.at("inputs"))
        info.inputs.push_back({input.at("path"), fromHex(input.at("hash"))});
    for (const Json& shape : json.at("shapes"))
        info.shapes.push_back({nameFrom(shape.at("name")), fromHex(shape.at("hash"))});
    for (const Json& body : json.at("bodies")) info.bodies.push_back(bodyFromJson(body));
    readPictures(json, info);
    info.offsets = json.value("subframes", std::vector<double>{0.0});
    info.hasContacts = json.value("contacts", false);
    info.resolvedShot = json.at("shot");
    return info;
}

}  // namespace

TakeInfo makeTakeInfo(const Shot& shot, const World& world, const SceneDescription& scene,
                      const std::string& programVersion)
{
    SCREE_CHECK(scene.bodies.size() == world.bodyCount(), "scene and world differ in size");
    TakeInfo info;
    info.programVersion = programVersion;
    info.name = shot.name;
    info.resolvedShot = shot.resolvedText;
    info.shotHash = hashText(shot.resolvedText);
    info.seed = shot.settings.seed;
    info.framesPerSecond = shot.framesPerSecond;
    info.metresPerUnit = shot.metresPerUnit;
    info.zUp = shot.zUp;
    info.firstFrame = shot.firstFrame;
    info.lastFrame = shot.lastFrame;
    info.inputs = hashInputs(shot);
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        const SceneBody& described = scene.bodies[body];
        info.bodies.push_back({described.name, scene.meshes[described.mesh].name,
                               world.shapeOf(body).isPlane, described.material,
                               world.info[body].kind, described.mass, described.isVisible});
    }
    describePictures(shot, info);
    info.offsets = sampleOffsets(shot.output.subframes);
    info.hasContacts = shot.output.contacts;
    return info;
}

std::string encodeTakeInfo(const TakeInfo& info)
{
    Json inputs = Json::array(), shapes = Json::array();
    for (const TakeInput& input : info.inputs)
        inputs.push_back({{"path", input.path}, {"hash", toHex(input.hash)}});
    for (const TakeShape& shape : info.shapes)
        shapes.push_back({{"name", shape.name}, {"hash", toHex(shape.hash)}});
    Json json = {
        {"format", kTakeFormat},
        {"format_version", kTakeFormatVersion},
        {"program_version", info.programVersion},
        {"name", info.name},
        {"fps", info.framesPerSecond},
        {"frames", {info.firstFrame, info.lastFrame}},
        {"metres_per_unit", info.metresPerUnit},
        {"up", info.zUp ? "+z" : "+y"},
        {"seed", info.seed},
        {"shot_hash", toHex(info.shotHash)},
        {"inputs", inputs},
        {"shapes", shapes},
        {"bodies", listToJson(info.bodies)},
        {"looks", listToJson(info.materials)},
        {"cameras", listToJson(info.cameras)},
        {"picture_size", info.pictureSize},
        {"burnin", info.burnIn},
        {"motion_blur", info.motionBlur},
        {"subframes", info.offsets},
        {"contacts", info.hasContacts},
        {"shot", info.resolvedShot},
    };
    if (!info.branchTake.empty()) {
        json["branch"] = {{"take", info.branchTake},
                          {"frame", info.branchFrame},
                          {"hash", toHex(info.branchHash)}};
    }
    // A folder may have a name in another coding: what is not UTF-8 of a path is written as U+FFFD.
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

bool isJson(const std::string& text)
{
    return Json::accept(text);
}

TakeInfo decodeTakeInfo(const std::string& text, const std::filesystem::path& path)
{
    const auto fail = [&](const std::string& why) {
        throw Error(ErrorKind::inputOutput, {path.string(), 0, 0},
                    why + "; the frames beside it are untouched");
    };
    TakeInfo info;
    try {
        const Json json = Json::parse(text);
        if (json.value("format", "") != kTakeFormat) fail("not the description of a Scree take");
        if (const int version = json.at("format_version"); version != kTakeFormatVersion)
            fail("take format " + std::to_string(version) + "; this program knows format " +
                 std::to_string(kTakeFormatVersion));
        info = infoFromJson(json);
        if (sampleOffsets(info.offsets) != info.offsets || !areSampleOffsets(info.offsets))
            fail("damaged: the offsets of \"subframes\" do not fit into a frame");
    } catch (const Error&) {
        throw;
    } catch (const std::exception& problem) {
        fail(std::string("damaged: ") + problem.what());
    }
    if (info.shotHash != hashText(info.resolvedShot))
        fail("damaged: the shot's text does not fit its hash");
    return info;
}

}  // namespace scree
