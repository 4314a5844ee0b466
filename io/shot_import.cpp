#include "io/shot_import.h"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/base/hash.h"
#include "io/file_bytes.h"
#include "io/mesh_import.h"
#include "io/nearest_word.h"
#include "io/shot_pose.h"
#include "io/unique_names.h"

namespace scree {
namespace {

constexpr std::size_t kNamesTold = 12;

/// Whether a name is what the pattern says, in which * stands for any letters and ? for one. Other
/// letters stand for themselves: programs call copies "Tile[1]".
bool fits(const std::string& pattern, const std::string& name)
{
    std::string escaped;
    for (const char letter : pattern) {
        if (letter == '[' || letter == ']' || letter == '\\') escaped += '\\';
        escaped += letter;
    }
    return ::fnmatch(escaped.c_str(), name.c_str(), 0) == 0;
}

/// Marks the nodes that one of the patterns fits.
std::vector<bool> chooseNodes(const ShotNode& patterns, const ImportedFile& file,
                              const std::string& path, ProblemList& problems)
{
    std::vector<std::string> names;
    for (const ImportedNode& node : file.nodes) names.push_back(node.name);
    std::vector<bool> isChosen(names.size(), false);
    const auto apply = [&](const ShotNode& pattern) {
        bool fitsAny = false;
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (!fits(pattern.text, names[i])) continue;
            isChosen[i] = fitsAny = true;
        }
        if (fitsAny) return;
        std::vector<std::string> told(names.begin(),
                                      names.begin() + std::min(names.size(), kNamesTold));
        problems.add(pattern.where, "no node of '" + path + "' is called " + toTomlText(pattern) +
                                        didYouMean(pattern.text, names) +
                                        " (it has: " + joined(told) +
                                        (told.size() < names.size() ? ", …" : "") + ")");
    };
    for (const ShotNode& pattern : patterns.items) apply(pattern);
    if (patterns.items.empty()) apply(patterns);
    return isChosen;
}

/// Gives equal meshes one owner.
class MeshPool {
public:
    std::shared_ptr<const TriMesh> share(TriMesh mesh)
    {
        std::uint64_t hash = hashBytes(mesh.points.data(), sizeof(double) * mesh.points.size());
        hash = hashBytes(mesh.triangles.data(), sizeof(int) * mesh.triangles.size(), hash);
        hash = hashBytes(mesh.cornerUvs.data(), sizeof(float) * mesh.cornerUvs.size(), hash);
        auto& known = meshes_[hash];
        if (!known) known = std::make_shared<const TriMesh>(std::move(mesh));
        return known;
    }

private:
    std::map<std::uint64_t, std::shared_ptr<const TriMesh>> meshes_;
};

/// glTF's up is +y; a shot whose up is +z has its files turned upright.
Pose uprightFromFile(const Shot& shot, const ImportedFile& file)
{
    const bool isTurned = shot.zUp && file.isYUp;
    const double half = std::sqrt(0.5);
    return {Vec3::Zero(), isTurned ? Quat(half, half, 0.0, 0.0) : Quat::Identity()};
}

/// Turns what a file says into the shot's world, as an empty would above all that a scene holds:
/// scaled and turned about the file's origin, then moved.
class Placement {
public:
    /// `node` is the [[import]] or [[camera]].
    Placement(const ShotNode& node, const Shot& shot, const ImportedFile& file,
              ProblemList& problems)
        : metres_(file.metresPerUnit.value_or(shot.metresPerUnit)),
          worldFromFile_(readPose(node, problems)),
          startSeconds_(file.countsFramesFromZero ? shot.firstFrame / shot.framesPerSecond : 0.0)
    {
        if (const ShotNode* scale = node.find("scale")) metres_ *= scale->number;
        if (const ShotNode* offset = node.find("offset"))
            startSeconds_ -= offset->number / shot.framesPerSecond;
        worldFromFile_.position *= shot.metresPerUnit;
        worldFromFile_ = worldFromFile_ * uprightFromFile(shot, file);
    }

    /// Length of one unit of the file in the shot, its scale included [m].
    double metresPerUnit() const { return metres_; }

    /// Of the shot's first frame, by the clock of the file.
    double startSeconds() const { return startSeconds_; }

    Pose worldFrom(const Pose& fileFromNode) const
    {
        return worldFromFile_ * Pose{metres_ * fileFromNode.position, fileFromNode.orientation};
    }

    /// The animation of what stands at `still` if it has none. A smooth one goes its own way from
    /// each of the file's keys to the next.
    std::vector<MotionKey> keysOf(const std::vector<ImportedKey>& animation, const Pose& still,
                                  KeyInterpolation interpolation) const
    {
        std::vector<MotionKey> keys;
        for (const ImportedKey& key : animation) {
            if (key.isBetween && interpolation == KeyInterpolation::smooth) continue;
            keys.push_back({key.seconds - startSeconds_, worldFrom(key.fileFromNode)});
        }
        if (keys.empty()) keys.push_back({0.0, worldFrom(still)});
        return keys;
    }

private:
    double metres_;
    Pose worldFromFile_;  // of the file's axes, in metres
    double startSeconds_;
};

/// The first camera that the pattern fits, or the first; null, and a report, when there is none.
const ImportedCamera* chooseCamera(const ShotNode* pattern, const ShotNode& fileKey,
                                   const ImportedFile& file, const std::string& path,
                                   ProblemList& problems)
{
    if (!pattern) {
        if (!file.cameras.empty()) return &file.cameras.front();
        problems.add(fileKey.where, "'" + path + "' has no camera");
        return nullptr;
    }
    std::vector<std::string> names;
    for (const ImportedCamera& camera : file.cameras) {
        if (fits(pattern->text, camera.name)) return &camera;
        names.push_back(camera.name);
    }
    problems.add(pattern->where,
                 "no camera of '" + path + "' is called " + toTomlText(*pattern) +
                     didYouMean(pattern->text, names) +
                     (names.empty() ? "; it has none" : " (it has: " + joined(names) + ")"));
    return nullptr;
}

/// The angle of view at a moment by the clock of the file, evenly between its samples.
double fovAt(const ImportedCamera& camera, double seconds)
{
    const std::vector<ImportedZoom>& zoom = camera.zoom;
    const auto after = std::find_if(zoom.begin(), zoom.end(),
                                    [&](const ImportedZoom& key) { return key.seconds > seconds; });
    if (after == zoom.begin()) return camera.fovDegrees;
    const ImportedZoom& before = after[-1];
    if (after == zoom.end()) return before.fovDegrees;
    const double share = (seconds - before.seconds) / (after->seconds - before.seconds);
    return before.fovDegrees + share * (after->fovDegrees - before.fovDegrees);
}

/// What a picture shows of the vertical angle of a film, which programs lay across its width, or
/// where it is taller than wide, across its height.
double fovInPicture(double filmDegrees, double filmAspect, const ShotRender& render)
{
    if (filmAspect == 0.0) return filmDegrees;
    const double aspect = static_cast<double>(render.size[0]) / render.size[1];
    const double share = aspect >= 1.0 ? filmAspect / aspect : std::max(filmAspect, 1.0);
    return 2.0 * std::atan(share * std::tan(0.5 * filmDegrees * kPi / 180.0)) * 180.0 / kPi;
}

/// How far from its eye a camera's target is, which files do not say: as far as the middle of what
/// moves, or else stands. Pictures take it for the scale of things, haze and near plane included.
double distanceToAction(const Pose& worldFromCamera, const Shot& shot)
{
    constexpr double kNoBodies = 10.0;  // [m]
    Vec3 moving = Vec3::Zero(), all = Vec3::Zero();
    int movingCount = 0, count = 0;
    for (const ShotBody& body : shot.bodies) {
        if (body.plane) continue;
        all += body.worldFromAsset.position;
        ++count;
        if (body.kind != BodyKind::dynamic) continue;
        moving += body.worldFromAsset.position;
        ++movingCount;
    }
    if (count == 0) return kNoBodies;
    const Vec3 middle = movingCount > 0 ? Vec3(moving / movingCount) : Vec3(all / count);
    const Vec3 way = middle - worldFromCamera.position;
    // It may look past the action, but not at its own nose.
    const double ahead = way.dot(worldFromCamera.orientation * -Vec3::UnitZ());
    const double distance = std::max(ahead, 0.5 * way.norm());
    return distance > 0.0 ? distance : kNoBodies;
}

/// Where a camera at a pose stands and what it looks at.
CameraKey keyAt(const Pose& worldFromCamera, double frame, double fovDegrees, const Shot& shot)
{
    const Vec3 way(0.0, 0.0, -distanceToAction(worldFromCamera, shot));
    return {frame, worldFromCamera.position, worldFromCamera * way, fovDegrees,
            worldFromCamera.orientation * Vec3::UnitY()};
}

/// Reports what cannot be played of the chosen nodes.
void requireMotion(const ShotNode& motion, const ImportedFile& file,
                   const std::vector<bool>& isChosen, ProblemList& problems)
{
    bool anyMoves = false;
    for (std::size_t i = 0; i < file.nodes.size(); ++i) {
        if (!isChosen[i]) continue;
        const ImportedNode& node = file.nodes[i];
        anyMoves = anyMoves || !node.keys.empty() || !node.obstacle.empty();
        if (node.obstacle.empty()) continue;
        problems.add(motion.where, "'" + node.name + "' cannot be keyed: " + node.obstacle);
    }
    if (anyMoves) return;
    problems.add(motion.where,
                 "the file animates none of these nodes; motion = \"static\" leaves them where "
                 "they are");
}

/// Reports which of the chosen nodes are no rigid bodies.
void requireBodies(const ShotNode& import, const ImportedFile& file, const std::string& path,
                   const std::vector<bool>& isChosen, ProblemList& problems)
{
    for (std::size_t i = 0; i < file.nodes.size(); ++i) {
        const ImportedNode& node = file.nodes[i];
        if (!isChosen[i] || node.unusable.empty()) continue;
        problems.add(import.find("file")->where,
                     refusalOf(node, path) + ", or leave it out of 'nodes'");
    }
}

/// "'A'", or "'A' and 3 more".
std::string someOf(const std::vector<std::string>& names)
{
    const std::string first = "'" + names.front() + "'";
    return names.size() == 1 ? first : first + " and " + std::to_string(names.size() - 1) + " more";
}

void warnOfJoin(const SourceLocation& where, const std::string& who, const std::string& how,
                ProblemList& problems)
{
    problems.warn(where, "the file joins the samples of " + who + " by " + how +
                             "; here they are joined steadily: export the motion with a sample for "
                             "every frame");
}

void warnOfClips(const SourceLocation& where, const std::string& who, const std::string& which,
                 ProblemList& problems)
{
    problems.warn(where, "several clips of the file move " + who + ": " + which +
                             "; export the one that is meant alone");
}

/// Warns of what other programs show otherwise: who trusts the file must know.
void warnOfLosses(const ShotNode& import, const ImportedFile& file,
                  const std::vector<bool>& isChosen, bool isKeyed, ProblemList& problems)
{
    std::map<std::string, std::vector<std::string>> joined;  // names by how samples are joined
    std::map<std::string, std::vector<std::string>> clips;   // names by which clip they play
    std::vector<std::string> bent;
    for (std::size_t i = 0; i < file.nodes.size(); ++i) {
        if (!isChosen[i]) continue;
        const ImportedNode& node = file.nodes[i];
        if (isKeyed && !node.lostJoin.empty()) joined[node.lostJoin].push_back(node.name);
        if (isKeyed && !node.lostClips.empty()) clips[node.lostClips].push_back(node.name);
        if (node.isBent) bent.push_back(node.name);
    }
    for (const auto& [how, names] : joined) {
        warnOfJoin(import.find("motion")->where, someOf(names), how, problems);
    }
    for (const auto& [which, names] : clips) {
        warnOfClips(import.find("motion")->where, someOf(names), which, problems);
    }
    if (bent.empty()) return;
    problems.warn(import.find("file")->where,
                  "bones or morph targets bend " + someOf(bent) +
                      " in other programs; here its form is the one it was modelled in: export it "
                      "with its deformers applied");
}

/// Of a file that lies on its side in the shot, unless it is turned there.
void warnOfUp(const ShotNode& node, const ImportedFile& file, const std::string& path,
              const Shot& shot, ProblemList& problems)
{
    const std::string up = shot.zUp ? "+z" : "+y";
    const bool isTurned = node.mentions("rotation") || node.mentions("orientation");
    if (file.upAxis.empty() || file.upAxis == up || isTurned) return;
    const std::string way = shot.zUp && file.upAxis == "+y"    ? ": rotation = [90, 0, 0] turns it"
                            : !shot.zUp && file.upAxis == "+z" ? ": rotation = [-90, 0, 0] turns it"
                                                               : ": 'rotation' turns it";
    problems.warn(node.find("file")->where, "'" + path + "' says that its up is " + file.upAxis +
                                                ", and the shot's is " + up + way);
}

ImportedFile readAsset(const std::string& path, const Shot& shot)
{
    if (const std::string obstacle = obstacleTo(path); !obstacle.empty())
        throw Error(ErrorKind::missingInput, "'" + path + "' cannot be reached: " + obstacle);
    return importFile(path, shot.importLimits);
}

}  // namespace

std::vector<PlacedNode> readImportedNodes(const ShotNode& node, const std::string& path,
                                          const Shot& shot, ProblemList& problems)
{
    std::vector<PlacedNode> result;
    ImportedFile file;
    try {
        file = readAsset(path, shot);
    } catch (const Error& error) {
        problems.add(node.find("file")->where, error.what(), error.kind());
        return result;
    }
    const std::vector<bool> isChosen = chooseNodes(*node.find("nodes"), file, path, problems);
    const ShotNode& motion = *node.find("motion");
    const bool isKeyed = motion.text == "keyed";
    const ShotNode* interpolate = node.find("interpolate");
    if (isKeyed) requireMotion(motion, file, isChosen, problems);
    for (const std::string key : {"interpolate", "keyed_from", "release", "offset"}) {
        const ShotNode* stray = node.find(key);
        if (stray && !isKeyed && !node.isUnclear("motion"))
            problems.add(stray->where, "'" + key + "' is for imports with motion = \"keyed\"");
    }
    requireBodies(node, file, path, isChosen, problems);
    warnOfLosses(node, file, isChosen, isKeyed, problems);
    warnOfUp(node, file, path, shot, problems);
    const Placement placement(node, shot, file, problems);
    MeshPool pool;
    for (std::size_t i = 0; i < file.nodes.size(); ++i) {
        if (!isChosen[i] || !file.nodes[i].unusable.empty()) continue;
        const ImportedNode& imported = file.nodes[i];
        PlacedNode placed;
        placed.name = imported.name.empty() ? "node" : plainName(imported.name);
        placed.name.resize(std::min(placed.name.size(), kLongestName));
        TriMesh mesh =
            transformed(imported.mesh, Pose(), Vec3::Constant(placement.metresPerUnit()));
        placed.shape = {path, pool.share(std::move(mesh))};
        placed.worldFromNode = placement.worldFrom(imported.fileFromNode);
        if (interpolate && interpolate->text == "smooth") {
            placed.interpolation = KeyInterpolation::smooth;
        }
        if (isKeyed) {
            placed.keys =
                placement.keysOf(imported.keys, imported.fileFromNode, placed.interpolation);
        }
        result.push_back(std::move(placed));
    }
    return result;
}

std::optional<SceneCamera> readImportedCamera(const ShotNode& node, const std::string& path,
                                              const Shot& shot, ProblemList& problems)
{
    ImportedFile file;
    try {
        file = readAsset(path, shot);
    } catch (const Error& error) {
        problems.add(node.find("file")->where, error.what(), error.kind());
        return std::nullopt;
    }
    const ImportedCamera* imported =
        chooseCamera(node.find("node"), *node.find("file"), file, path, problems);
    if (!imported) return std::nullopt;
    if (imported->fovDegrees == 0.0) {
        const ShotNode* chosen = node.find("node");
        problems.add(chosen ? chosen->where : node.find("file")->where,
                     "camera '" + imported->name + "' of '" + path +
                         "' is orthographic: only perspective ones can be used");
        return std::nullopt;
    }
    if (!imported->unusable.empty()) {
        problems.add(node.find("file")->where,
                     "camera '" + imported->name + "' of '" + path + "' " + imported->unusable);
        return std::nullopt;
    }
    warnOfUp(node, file, path, shot, problems);
    const Placement placement(node, shot, file, problems);
    // Between samples it turns steadily, as elsewhere; a key a frame keeps it from cutting corners.
    constexpr KeyInterpolation kSteady = KeyInterpolation::linear;
    const MotionScript script(placement.keysOf(imported->keys, imported->fileFromCamera, kSteady),
                              kSteady);
    const bool changes = !imported->keys.empty() || !imported->zoom.empty();
    SceneCamera camera;
    camera.isSmooth = false;
    for (int frame = shot.firstFrame; frame <= shot.lastFrame; ++frame) {
        const double seconds = (frame - shot.firstFrame) / shot.framesPerSecond;
        const double fov = fovInPicture(fovAt(*imported, seconds + placement.startSeconds()),
                                        imported->filmAspect, shot.render);
        camera.keys.push_back(keyAt(script.at(seconds), frame, fov, shot));
        if (!changes) break;
    }
    const CameraKey& first = camera.keys.front();
    camera.eye = first.eye;
    camera.target = first.target;
    camera.fovDegrees = first.fovDegrees;
    camera.up = first.up;
    if (!changes) camera.keys.clear();
    if (!imported->lostJoin.empty()) {
        warnOfJoin(node.find("file")->where, "camera '" + imported->name + "'", imported->lostJoin,
                   problems);
    }
    if (!imported->lostClips.empty()) {
        warnOfClips(node.find("file")->where, "camera '" + imported->name + "'",
                    imported->lostClips, problems);
    }
    if (!imported->lostLens.empty()) {
        problems.warn(node.find("file")->where,
                      "the " + imported->lostLens + " of camera '" + imported->name + "' of '" +
                          path +
                          "' is not shown here: other programs show another part of the "
                          "scene");
    }
    if (imported->isZoomLost) {
        problems.warn(node.find("file")->where,
                      "the zoom of camera '" + imported->name + "' of '" + path +
                          "' cannot be read: it keeps the angle of view it begins with; a zoom of "
                          "an Alembic file is kept");
    }
    return camera;
}

}  // namespace scree
