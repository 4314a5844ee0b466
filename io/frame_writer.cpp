#include "io/frame_writer.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_set>

#include "core/base/check.h"
#include "core/base/error.h"
#include "io/alembic_writer.h"
#include "io/frame_pattern.h"
#include "io/gltf_writer.h"
#include "io/mesh_sequence_writer.h"
#include "io/pov_writer.h"
#include "io/text_forms.h"
#include "io/usd_writer.h"

namespace scree {

namespace {

namespace fs = std::filesystem;

// One row per format; a new format is a new row. Of two endings that fit the first counts.
struct Format {
    std::string_view ending;
    bool isSequence;  ///< one file per frame
    std::unique_ptr<FrameWriter> (*make)(const fs::path& output);
};

constexpr Format kFormats[] = {
    {".abc", false, makeAlembicWriter},    {".instances.usda", false, makeUsdInstancesWriter},
    {".usda", false, makeUsdWriter},       {".glb", false, makeGltfWriter},
    {".obj", true, makeObjSequenceWriter}, {".ply", true, makePlySequenceWriter},
    {".pov", true, makePovWriter},
};

std::string knownEndings()
{
    std::string list;
    for (const Format& format : kFormats) {
        if (!list.empty()) list += ", ";
        list += (format.isSequence ? ".####" : "") + std::string(format.ending);
    }
    return list;
}

/// The row for the ending of `output`; null if there is none.
const Format* findFormat(const fs::path& output)
{
    const std::string name = inSmallLetters(output.filename().string());
    for (const Format& format : kFormats) {
        if (name.size() > format.ending.size() && name.ends_with(format.ending)) return &format;
    }
    return nullptr;
}

const Format& formatOf(const fs::path& output)
{
    if (const Format* format = findFormat(output)) return *format;
    throw Error(ErrorKind::usage, "cannot export to \"" + output.string() +
                                      "\": expected a name ending in " + knownEndings());
}

bool isIdentifier(std::string_view name)
{
    const auto fits = [](unsigned char letter) {
        return letter < 128 && (std::isalnum(letter) || letter == '_');
    };
    return !name.empty() && std::all_of(name.begin(), name.end(), fits);
}

/// Names become object names and paths in the cache. They are refused, not changed, so that an
/// artist finds a body under the name the shot gives it.
void requireIdentifier(std::string_view what, const std::string& name)
{
    if (isIdentifier(name)) return;
    throw Error(ErrorKind::badInput, "cannot export the " + std::string(what) + " \"" + name +
                                         "\": names may hold letters, digits and _ only");
}

/// Most formats hold numbers in single precision, where what is larger becomes infinite, or a word
/// that no reader takes for a number.
template <class Derived>
bool fits(const Eigen::MatrixBase<Derived>& numbers)
{
    return (numbers.array().abs() <= double{std::numeric_limits<float>::max()}).all();
}
constexpr const char* kMisfit =
    "is not finite, or beyond 3.4e38, the largest number that a cache can hold";

void requireMesh(const SceneMesh& mesh)
{
    const bool cornersExist = mesh.triangles.size() == 0 ||
                              (mesh.triangles.minCoeff() >= 0 &&
                               mesh.triangles.maxCoeff() < static_cast<int>(mesh.points.cols()));
    SCREE_CHECK(cornersExist, "mesh " + mesh.name + ": a triangle names a point it does not have");
    SCREE_CHECK(mesh.cornerUvs.cols() == 0 || mesh.cornerUvs.cols() == mesh.triangles.size(),
                "mesh " + mesh.name + ": texture coordinates for other corners than it has");
    if (fits(mesh.points) && fits(mesh.cornerUvs)) return;
    throw Error(ErrorKind::badInput,
                "cannot export the mesh \"" + mesh.name + "\": a point of it " + kMisfit);
}

void requireExportable(const SceneDescription& scene)
{
    requireIdentifier("shot", scene.name);
    for (const SceneMesh& mesh : scene.meshes) requireMesh(mesh);

    for (const SceneCamera& camera : scene.cameras) requireIdentifier("camera", camera.name);

    std::unordered_set<std::string_view> names;
    for (const SceneBody& body : scene.bodies) {
        requireIdentifier("body", body.name);
        if (!body.material.empty()) requireIdentifier("material", body.material);
        SCREE_CHECK(body.mesh < scene.meshes.size(), "body " + body.name + " names no mesh");
        if (names.insert(body.name).second) continue;
        throw Error(ErrorKind::badInput,
                    "cannot export: two bodies are called \"" + body.name + "\"");
    }
}

bool fits(const SceneFrame& frame, std::size_t body)
{
    const Pose& pose = frame.worldFromAsset[body];
    return fits(pose.position) && fits(pose.orientation.coeffs()) && fits(frame.velocity[body]) &&
           fits(frame.angularVelocity[body]);
}

}  // namespace

void FrameWriter::begin(const SceneDescription& scene, int firstFrame, int frameCount,
                        const std::vector<double>& offsets)
{
    SCREE_CHECK(scene_ == nullptr, "begin() called twice");
    SCREE_CHECK(frameCount > 0, "an export needs at least one frame");
    SCREE_CHECK(scene.framesPerSecond > 0.0, "frames per second must be positive");
    SCREE_CHECK(std::find(offsets.begin(), offsets.end(), 0.0) != offsets.end() &&
                    std::is_sorted(offsets.begin(), offsets.end()) &&
                    offsets.back() - offsets.front() < 1.0,
                "sub-frame offsets must ascend within a frame and hold 0");
    SCREE_CHECK(offsets.size() == 1 || holdsSubframes(), "the format holds whole frames only");
    requireExportable(scene);
    offsets_ = offsets;
    nextSample_ = 0;
    scene_ = &scene;
    nextFrame_ = firstFrame_ = firstFrame;
    framesLeft_ = frameCount_ = frameCount;
    beginScene(scene, firstFrame, frameCount);
}

void FrameWriter::write(const SceneFrame& frame)
{
    SCREE_CHECK(scene_ != nullptr && framesLeft_ > 0, "a frame that begin() did not announce");
    SCREE_CHECK(frame.frame == nextFrame_, "expected frame " + std::to_string(nextFrame_) +
                                               ", got " + std::to_string(frame.frame));
    SCREE_CHECK(frame.offset == offsets_[nextSample_], "expected the sample at " +
                                                           std::to_string(offsets_[nextSample_]) +
                                                           ", got " + std::to_string(frame.offset));
    const std::size_t bodyCount = scene_->bodies.size();
    SCREE_CHECK(frame.worldFromAsset.size() == bodyCount && frame.velocity.size() == bodyCount &&
                    frame.angularVelocity.size() == bodyCount,
                "a frame must hold every body");
    for (std::size_t body = 0; body < bodyCount; ++body) {
        if (fits(frame, body)) continue;
        throw Error(ErrorKind::qualityLimit, "cannot export frame " + std::to_string(frame.frame) +
                                                 ": pose or velocity of \"" +
                                                 scene_->bodies[body].name + "\" " + kMisfit);
    }
    writeFrame(frame);
    if (++nextSample_ < offsets_.size()) return;
    nextSample_ = 0;
    ++nextFrame_;
    --framesLeft_;
}

std::vector<double> FrameWriter::times() const
{
    std::vector<double> times;
    for (int frame = firstFrame_; frame < firstFrame_ + frameCount_; ++frame)
        for (const double offset : offsets_) times.push_back(frame + offset);
    return times;
}

void FrameWriter::finish(const FinishWatch& watch)
{
    SCREE_CHECK(scene_ != nullptr && framesLeft_ == 0,
                std::to_string(framesLeft_) + " announced frames were not written");
    finishScene(watch);
    scene_ = nullptr;
}

bool isExportable(const fs::path& output)
{
    return findFormat(output) != nullptr;
}

bool isFrameSequence(const fs::path& output)
{
    return formatOf(output).isSequence;
}

std::unique_ptr<FrameWriter> makeFrameWriter(const fs::path& output)
{
    const Format& format = formatOf(output);
    if (format.isSequence) {
        expandFramePattern(output.string(), 0);  // explains itself if there is no place
    } else if (hasFramePattern(output.string())) {
        throw Error(ErrorKind::usage, "\"" + output.string() + "\": one " +
                                          std::string(format.ending) +
                                          " file holds all frames; leave out the frame number");
    }
    return format.make(output);
}

std::unique_ptr<FrameWriter> makePoseWriter(const fs::path& output)
{
    const Format& format = formatOf(output);
    return format.isSequence ? format.make(output) : makeFrameWriter(output);
}

}  // namespace scree
