#include "io/usd_writer.h"

#include <optional>

#include "io/motion_spool.h"
#include "io/usd_instancer.h"
#include "io/usd_stage.h"

namespace scree {

namespace {

namespace fs = std::filesystem;

/// Reading a frame and setting it aside is quick, numbers as text are not.
constexpr double kFinishCost = 3.0;

enum class UsdForm { primPerBody, instancer };

class UsdWriter final : public FrameWriter {
public:
    UsdWriter(fs::path output, UsdForm form) : output_(std::move(output)), form_(form) {}

    bool holdsSubframes() const override { return true; }
    double finishCost() const override { return kFinishCost; }

private:
    void beginScene(const SceneDescription& scene, int firstFrame, int frameCount) override;
    void writeFrame(const SceneFrame& frame) override;
    void finishScene(const FinishWatch& watch) override;

    void writeMovingBodies(UsdText& text, const FinishWatch& watch);
    void writeStaticBodies(UsdText& text) const;
    void openBody(UsdText& text, std::size_t body) const;
    void writeOpsAndBirth(UsdText& text, const SceneBody& body) const;

    fs::path output_;
    UsdForm form_;
    const SceneDescription* scene_ = nullptr;
    int firstFrame_ = 0, frameCount_ = 0;
    std::optional<UsdNames> names_;
    std::optional<AtomicFile> file_;
    std::optional<MotionSpool> motion_;  // of the bodies that move
    std::vector<Pose> firstPoses_;       // of all
};

constexpr const char* kPlaceOps =
    "uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"]";
constexpr const char* kPlaceAndSizeOps =
    "uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\", "
    "\"xformOp:scale\"]";

/// Values are joined steadily from time to time: what jumps does so within this [frames].
constexpr double kJump = 1e-3;

std::string translationText(const MotionSample& sample)
{
    return usdTuple(sample.worldFromAsset.position);
}

std::string orientationText(const MotionSample& sample)
{
    return usdTuple(usdQuaternion(sample.worldFromAsset.orientation));
}

void writeTrack(UsdText& text, const std::string& attribute, const std::vector<double>& times,
                std::span<const MotionSample> track, std::string (*valueText)(const MotionSample&))
{
    std::vector<std::string> values;
    values.reserve(track.size());
    for (const MotionSample& sample : track) values.push_back(valueText(sample));
    writeUsdTrack(text, attribute, times, values);
}

void UsdWriter::beginScene(const SceneDescription& scene, int firstFrame, int frameCount)
{
    scene_ = &scene;
    firstFrame_ = firstFrame;
    frameCount_ = frameCount;
    names_.emplace(scene);
    file_.emplace(output_);
    std::vector<std::size_t> moving;
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        if (scene.bodies[body].moves) moving.push_back(body);
    }
    motion_.emplace(file_->target().parent_path(), std::move(moving));
}

void UsdWriter::writeFrame(const SceneFrame& frame)
{
    if (firstPoses_.empty()) firstPoses_ = frame.worldFromAsset;
    motion_->append(frame);
}

void UsdWriter::finishScene(const FinishWatch& watch)
{
    writeUsdHeader(*file_, *names_, *scene_, firstFrame_, firstFrame_ + frameCount_ - 1);
    UsdText text(*file_);
    text.openPrim(usdPrim("Xform", names_->root), {"kind = \"assembly\""});
    writeUsdOldName(text, scene_->name, names_->root);
    writeUsdMaterials(text, *names_, *scene_);
    writeUsdMeshes(text, *names_, *scene_);
    writeUsdCameras(text, *names_, *scene_, times());
    writeStaticBodies(text);
    if (form_ == UsdForm::instancer) {
        writeUsdInstancer(text, *names_, *scene_, firstFrame_, *motion_, watch);
    } else {
        writeMovingBodies(text, watch);
    }
    text.closePrim();
    motion_.reset();
    file_->commit();
}

void UsdWriter::openBody(UsdText& text, std::size_t body) const
{
    const SceneBody& scenes = scene_->bodies[body];
    text.openPrim(usdPrim("Xform", names_->bodies[body]), usdBodyMetadata(*names_, scenes, true));
    writeUsdBodyProperties(text, *names_, *scene_, scenes);
    text.line("custom int userProperties:bodyId = " + numberText(body));
    writeUsdOldName(text, scenes.name, names_->bodies[body]);
    if (!scenes.isVisible) text.line("token visibility = \"invisible\"");
}

/// The body's order of transforms, and when it becomes visible if that is not from the first frame
/// on; visibility holds until the next time that has one. Blender does not read it, so the body has
/// no size either until then.
void UsdWriter::writeOpsAndBirth(UsdText& text, const SceneBody& body) const
{
    if (!body.isVisible || isSeen(body, firstFrame_)) return text.line(kPlaceOps);
    const bool comes = isSeen(body, firstFrame_ + frameCount_ - 1);
    text.openTimes("double3 xformOp:scale");
    text.time(firstFrame_, "(0, 0, 0)");
    if (comes) {
        if (body.birthFrame - kJump > firstFrame_) text.time(body.birthFrame - kJump, "(0, 0, 0)");
        text.time(body.birthFrame, "(1, 1, 1)");
    }
    text.closeTimes();
    text.line(kPlaceAndSizeOps);
    text.openTimes("token visibility");
    text.time(firstFrame_, "\"invisible\"");
    if (comes) text.time(body.birthFrame, "\"inherited\"");
    text.closeTimes();
}

void UsdWriter::writeStaticBodies(UsdText& text) const
{
    for (std::size_t body = 0; body < scene_->bodies.size(); ++body) {
        if (scene_->bodies[body].moves) continue;
        const Pose& pose = firstPoses_[body];
        openBody(text, body);
        const Quat orientation = pose.orientation.normalized();
        text.line("quatd xformOp:orient = " + usdTuple(usdQuaternion(orientation)));
        text.line("double3 xformOp:translate = " + usdTuple(pose.position));
        text.line(kPlaceOps);
        text.closePrim();
    }
}

void UsdWriter::writeMovingBodies(UsdText& text, const FinishWatch& watch)
{
    const auto count = static_cast<double>(motion_->bodies().size());
    motion_->visitTracks([&](std::size_t k, std::span<const MotionSample> track) {
        watch(static_cast<double>(k) / count);
        openBody(text, motion_->bodies()[k]);
        writeTrack(text, "quatd xformOp:orient", motion_->times(), track, orientationText);
        writeTrack(text, "double3 xformOp:translate", motion_->times(), track, translationText);
        writeOpsAndBirth(text, scene_->bodies[motion_->bodies()[k]]);
        text.closePrim();
    });
}

}  // namespace

std::unique_ptr<FrameWriter> makeUsdWriter(const fs::path& output)
{
    return std::make_unique<UsdWriter>(output, UsdForm::primPerBody);
}

std::unique_ptr<FrameWriter> makeUsdInstancesWriter(const fs::path& output)
{
    return std::make_unique<UsdWriter>(output, UsdForm::instancer);
}

}  // namespace scree
