#include "tools/take_painter.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/point_box.h"
#include "core/picture/camera_motion.h"
#include "io/nearest_word.h"
#include "io/subframes.h"
#include "io/text_forms.h"
#include "render/rasterizer.h"
#include "render/ray_tracer.h"
#include "render/text.h"

namespace scree {
namespace {

/// Half the time that the shutter is open where the take has no samples that tell [frames].
constexpr double kHalfShutter = 0.25;

/// The sample at `offset` frames from the frame that `samples` surround: between two of them, or
/// coasting beyond the outermost.
SceneFrame sampleAt(const std::vector<SceneFrame>& samples, double offset, double framesPerSecond)
{
    const auto after = std::find_if(samples.begin(), samples.end(),
                                    [&](const SceneFrame& s) { return s.offset >= offset; });
    if (after == samples.begin() || after == samples.end()) {
        const SceneFrame& nearest = after == samples.end() ? samples.back() : *after;
        return coasted(nearest, (offset - nearest.offset) / framesPerSecond);
    }
    const SceneFrame& a = *(after - 1);
    const SceneFrame& b = *after;
    const double frames = b.offset - a.offset;
    return inBetween(a, b, (offset - a.offset) / frames, frames / framesPerSecond);
}

/// Which bodies have fallen off the set: below all that stands there, and not from the start. What
/// rolled off a table fell on, and the table was a few pixels wide.
class FallenOff {
public:
    FallenOff(const SceneDescription& scene, const Vec3& up)
        : up_(up), hasBegunAbove_(scene.bodies.size(), 0)
    {
    }

    /// There is a ground that nobody falls off.
    void standsOnPlane() { lowest_ = -std::numeric_limits<double>::infinity(); }

    /// Of the set, one box after the other.
    void standsAt(const Aabb& box) { lowest_ = std::min(lowest_, spanOf(box).first); }

    /// Whether what moves has, in frames from the first on.
    bool contains(std::size_t body, const Aabb& box)
    {
        const bool isBelow = spanOf(box).second < lowest_;
        if (!isBelow) hasBegunAbove_[body] = 1;
        return isBelow && hasBegunAbove_[body];
    }

private:
    /// From its lowest to its highest place.
    std::pair<double, double> spanOf(const Aabb& box) const
    {
        return std::minmax(up_.dot(box.min), up_.dot(box.max));
    }

    Vec3 up_;
    double lowest_ = std::numeric_limits<double>::infinity();
    std::vector<char> hasBegunAbove_;
};

/// What movable bodies do, or all bodies when none moves; planes not at all.
Camera frameAction(const TakeReader& take, const SceneDescription& scene, double aspect)
{
    std::vector<Aabb> meshBoxes;
    for (const SceneMesh& mesh : scene.meshes) meshBoxes.push_back(boxOf(mesh.points));

    const Vec3 up = scene.zUp ? Vec3::UnitZ() : Vec3::UnitY();
    Framing view(threeQuarterView(scene.zUp), up, aspect);
    std::vector<Framing> seen(scene.bodies.size(), view);
    FallenOff fallenOff(scene, up);
    std::vector<std::pair<std::size_t, Aabb>> boxes;  // of a frame
    take.forWholeFrames(take.frames(), [&](int number, const SceneFrame& frame) {
        boxes.clear();
        for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
            if (take.info().bodies[body].isPlane) {
                fallenOff.standsOnPlane();
                continue;
            }
            if (!isSeen(scene.bodies[body], number)) continue;
            const Pose& pose = frame.worldFromAsset[body];
            const Aabb box = transformed(meshBoxes[scene.bodies[body].mesh],
                                         pose.orientation.toRotationMatrix(), pose.position);
            if (!scene.bodies[body].moves) fallenOff.standsAt(box);
            boxes.push_back({body, box});
        }
        for (const auto& [body, box] : boxes) {
            if (!scene.bodies[body].moves || !fallenOff.contains(body, box))
                seen[body].include(box);
        }
    });
    std::vector<Framing> moving, all;
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
        if (seen[body].isEmpty()) continue;
        all.push_back(seen[body]);
        if (scene.bodies[body].moves) moving.push_back(seen[body]);
    }
    if (!all.empty())
        view.includeMost(moving.empty() ? all : moving);
    else
        view.include(Aabb{-Vec3::Ones(), Vec3::Ones()});
    return view.camera();
}

SceneCamera chooseCamera(const TakeReader& take, const SceneDescription& scene,
                         const std::string& name, double aspect)
{
    std::vector<std::string> known;
    for (const SceneCamera& camera : take.info().cameras) {
        if (name.empty() || camera.name == name) return camera;
        known.push_back(camera.name);
    }
    if (!name.empty())
        throw Error(ErrorKind::usage, "the shot has no camera \"" + name + "\"" +
                                          didYouMean(name, known) +
                                          (known.empty() ? "" : " (it has " + joined(known) + ")"));
    return viewOfAction(take, scene, aspect);
}

}  // namespace

SceneCamera viewOfAction(const TakeReader& take, const SceneDescription& scene, double aspect)
{
    const Camera view = frameAction(take, scene, aspect);
    SceneCamera camera;
    camera.name = "view";
    camera.eye = view.eye;
    camera.target = view.target;
    camera.fovDegrees = view.fovDegrees;
    return camera;
}

/// An engine of its own for as long as a picture takes.
class TakePainter::BorrowedEngine {
public:
    explicit BorrowedEngine(TakePainter& painter) : painter_(painter)
    {
        // Engines are made under the lock too: OSMesa starts up with the first of them.
        const std::lock_guard lock(painter_.engineLock_);
        if (painter_.freeEngines_.empty()) {
            engine_ = painter_.makeEngine();
        } else {
            engine_ = std::move(painter_.freeEngines_.back());
            painter_.freeEngines_.pop_back();
        }
    }
    BorrowedEngine(const BorrowedEngine&) = delete;
    BorrowedEngine& operator=(const BorrowedEngine&) = delete;
    ~BorrowedEngine()
    {
        const std::lock_guard lock(painter_.engineLock_);
        painter_.freeEngines_.push_back(std::move(engine_));
    }
    PictureEngine* operator->() const { return engine_.get(); }
    PictureEngine& operator*() const { return *engine_; }

private:
    TakePainter& painter_;
    std::unique_ptr<PictureEngine> engine_;
};

TakePainter::TakePainter(const TakeReader& take, const std::string& cameraName,
                         const std::array<int, 2>& size, const PaintSettings& settings)
    : take_(take),
      scene_(take.describe(TakeReader::PlaneSize::any)),
      camera_(chooseCamera(take, scene_, cameraName, static_cast<double>(size[0]) / size[1])),
      size_(size),
      settings_(settings),
      looks_(take, scene_, settings.look)
{
}

Camera TakePainter::cameraAtFrame(double frame) const
{
    const SceneCamera now = cameraAt(camera_, frame, scene_.zUp);
    return {now.eye, now.target, upOf(now, scene_.zUp), now.fovDegrees};
}

std::unique_ptr<PictureEngine> TakePainter::makeEngine() const
{
    StageSettings stage;
    stage.wireframe = settings_.look == LookKind::wireframe;
    if (settings_.isRayTraced) {
        TraceSettings settings{stage};
        if (settings_.samples > 0) settings.samples = settings_.samples;
        // A blurred picture is the mean of several: each needs only its share of the rays.
        if (settings_.motionBlur > 1)
            settings.samples = std::max(1, settings.samples / settings_.motionBlur);
        return std::make_unique<RayTracer>(scene_, looks_.materials(), settings);
    }
    RasterSettings settings{stage};
    if (settings_.samples > 0) settings.samples = settings_.samples;
    return std::make_unique<Rasterizer>(scene_, looks_.materials(), settings);
}

std::string TakePainter::viewAt(int frame) const
{
    const Camera camera = cameraAtFrame(frame);
    std::string text = "seen from";
    for (const Vec3& place : {camera.eye, camera.target, camera.up})
        for (const double number : place) text += formatted(" %.9g", number);
    return text + formatted(" at %.9g degrees", camera.fovDegrees) + looks_.scaleText();
}

std::size_t TakePainter::bodyCountAt(int frame) const
{
    return static_cast<std::size_t>(std::ranges::count_if(
        scene_.bodies, [&](const SceneBody& body) { return isSeen(body, frame); }));
}

int TakePainter::usefulThreads() const
{
    return settings_.isRayTraced ? 1 : threadCount();
}

Image TakePainter::paint(int frame, const std::string& burnedIn)
{
    BorrowedEngine engine(*this);
    const SceneFrame now = take_.readFrame(frame);
    if (looks_.isDiagnostic()) engine->setLooks(looks_.looksAt(now));
    const Camera camera = cameraAtFrame(frame);
    Image image = settings_.motionBlur < 2 ? engine->draw(now, camera, size_[0], size_[1])
                                           : drawBlurred(*engine, frame);
    looks_.drawOver(image, camera, frame);
    if (!burnedIn.empty()) burnIn(image, burnedIn);
    return image;
}

/// The mean of the moments in the middle of equal shares of the time that the shutter is open.
Image TakePainter::drawBlurred(PictureEngine& engine, int frame) const
{
    const std::vector<SceneFrame> samples = take_.readSamples(frame);
    const bool tells = samples.size() > 1;
    const double opens = tells ? samples.front().offset : -kHalfShutter;
    const double closes = tells ? samples.back().offset : kHalfShutter;
    Image image(size_[0], size_[1]);
    for (int i = 0; i < settings_.motionBlur; ++i) {
        const double offset = opens + (closes - opens) * (i + 0.5) / settings_.motionBlur;
        const SceneFrame moment = sampleAt(samples, offset, take_.info().framesPerSecond);
        addShare(image, engine.draw(moment, cameraAtFrame(frame + offset), size_[0], size_[1], i),
                 1.0f / static_cast<float>(settings_.motionBlur));
    }
    return image;
}

}  // namespace scree
