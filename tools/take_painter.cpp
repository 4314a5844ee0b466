#include "tools/take_painter.h"

#include <algorithm>
#include <map>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/math/aabb.h"
#include "io/nearest_word.h"
#include "io/subframes.h"
#include "render/rasterizer.h"
#include "render/ray_tracer.h"
#include "render/text.h"
#include "tools/command_line.h"

namespace scree {
namespace {

/// Frames that are looked at to find how fast bodies get.
constexpr int kScaleFrames = 24;

/// Half the time that the shutter is open where the take has no samples that tell [frames].
constexpr double kHalfShutter = 0.25;

const std::array<std::pair<const char*, LookKind>, 5> kLookWords = {{
    {"shaded", LookKind::shaded},
    {"wireframe", LookKind::wireframe},
    {"speed", LookKind::speed},
    {"sleep", LookKind::sleep},
    {"id", LookKind::id},
}};

const Look kStillLook = {{0.10, 0.22, 0.42}, 0.7}, kMovingLook = {{0.78, 0.30, 0.07}, 0.7};

/// The next number at or above `value` that is 1, 2 or 5 times a power of ten.
double roundedUp(double value)
{
    double step = 1e-6;
    for (int i = 0; step < value && i < 60; ++i) step *= i % 3 == 1 ? 2.5 : 2.0;
    return step;
}

/// A colour that is unlike those of bodies nearby in the list.
Vec3 colorOfId(std::size_t body)
{
    const double hue = 6.0 * randomUnit(11, body), light = 0.25 + 0.45 * randomUnit(12, body);
    Vec3 color;
    for (int i = 0; i < 3; ++i) {
        const double turned = std::fmod(hue + 2.0 * i, 6.0);
        color[i] = light * (0.15 + 0.85 * std::clamp(std::abs(turned - 3.0) - 1.0, 0.0, 1.0));
    }
    return color;
}

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
    const double share = (offset - a.offset) / (b.offset - a.offset);
    SceneFrame result = a;
    for (std::size_t i = 0; i < result.worldFromAsset.size(); ++i) {
        const Pose &from = a.worldFromAsset[i], &to = b.worldFromAsset[i];
        result.worldFromAsset[i] = {(1.0 - share) * from.position + share * to.position,
                                    from.orientation.slerp(share, to.orientation)};
    }
    return result;
}

std::vector<Look> looksOf(const TakeInfo& info, const SceneDescription& scene)
{
    std::map<std::string, Look> byMaterial;
    for (const TakeLook& look : info.looks)
        byMaterial[look.material] = {look.color, look.roughness};
    std::vector<Look> looks;
    for (const SceneBody& body : scene.bodies) looks.push_back(byMaterial[body.material]);
    return variedLooks(scene, looks);
}

/// Around everything that movable bodies do, or around all bodies when none moves; planes not at
/// all.
Aabb actionBox(const TakeReader& take, const SceneDescription& scene)
{
    std::vector<Aabb> meshBoxes(scene.meshes.size());
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh)
        for (Eigen::Index i = 0; i < scene.meshes[mesh].points.cols(); ++i)
            meshBoxes[mesh].include(Vec3(scene.meshes[mesh].points.col(i)));

    Aabb moving, all;
    for (const int number : take.frames()) {
        const SceneFrame frame = take.readFrame(number);
        for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
            if (take.info().bodies[body].isPlane) continue;
            if (!isThere(scene.bodies[body], number)) continue;
            const Pose& pose = frame.worldFromAsset[body];
            const Aabb box = transformed(meshBoxes[scene.bodies[body].mesh],
                                         pose.orientation.toRotationMatrix(), pose.position);
            all.include(box);
            if (scene.bodies[body].moves) moving.include(box);
        }
    }
    if (!moving.isEmpty()) return moving;
    return all.isEmpty() ? Aabb{-Vec3::Ones(), Vec3::Ones()} : all;
}

Camera chooseCamera(const TakeReader& take, const SceneDescription& scene, const std::string& name,
                    double aspect)
{
    const Vec3 up = scene.zUp ? Vec3::UnitZ() : Vec3::UnitY();
    std::string known;
    for (const TakeCamera& camera : take.info().cameras) {
        if (name.empty() || camera.name == name)
            return {camera.eye, camera.target, up, camera.fovDegrees};
        known += (known.empty() ? "" : ", ") + camera.name;
    }
    if (!name.empty())
        throw Error(ErrorKind::usage, "the shot has no camera \"" + name + "\"" +
                                          (known.empty() ? "" : "; it has " + known));
    const SceneCamera view = viewOfAction(take, scene, aspect);
    return {view.eye, view.target, up, view.fovDegrees};
}

}  // namespace

SceneCamera viewOfAction(const TakeReader& take, const SceneDescription& scene, double aspect)
{
    const Vec3 up = scene.zUp ? Vec3::UnitZ() : Vec3::UnitY();
    const Camera view = frameAll(actionBox(take, scene), threeQuarterView(scene.zUp), up, aspect);
    return {"view", view.eye, view.target, view.fovDegrees};
}

LookKind parseLook(const std::string& word)
{
    std::vector<std::string> known;
    for (const auto& [name, kind] : kLookWords) {
        if (word == name) return kind;
        known.push_back(name);
    }
    throw Error(ErrorKind::usage,
                "--look " + word + ": the looks are " + joined(known) + didYouMean(word, known));
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

private:
    TakePainter& painter_;
    std::unique_ptr<PictureEngine> engine_;
};

TakePainter::TakePainter(const TakeReader& take, const std::string& cameraName,
                         const std::array<int, 2>& size, const PaintSettings& settings)
    : take_(take), scene_(take.describe()), size_(size), settings_(settings)
{
    const double aspect = static_cast<double>(size[0]) / size[1];
    camera_ = chooseCamera(take, scene_, cameraName, aspect);
    materialLooks_ = looksOf(take.info(), scene_);
    if (settings.look == LookKind::speed) chooseScale();
    if (settings.look == LookKind::sleep)
        legend_.entries = {{kMovingLook.color.cast<float>(), "moves"},
                           {kStillLook.color.cast<float>(), "stands still"}};
}

/// One scale for the whole shot: a colour means the same speed in every picture.
void TakePainter::chooseScale()
{
    double fastest = 1e-3;
    for (const int number : spreadFrames(take_.frames(), kScaleFrames))
        for (const Vec3& velocity : take_.readFrame(number).velocity)
            if (velocity.allFinite()) fastest = std::max(fastest, velocity.norm());
    fastest_ = roundedUp(fastest);
    legend_.title = "units/s";
    legend_.scaleEnd = fastest_;
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
        return std::make_unique<RayTracer>(scene_, materialLooks_, settings);
    }
    RasterSettings settings{stage};
    if (settings_.samples > 0) settings.samples = settings_.samples;
    return std::make_unique<Rasterizer>(scene_, materialLooks_, settings);
}

int TakePainter::usefulThreads() const
{
    return settings_.isRayTraced ? 1 : threadCount();
}

std::vector<Look> TakePainter::looksIn(const SceneFrame& frame) const
{
    std::vector<Look> looks = materialLooks_;
    for (std::size_t body = 0; body < looks.size(); ++body) {
        if (!scene_.bodies[body].moves) {
            looks[body].color = Vec3::Constant(0.35 * looks[body].color.mean() + 0.1);
            continue;
        }
        const Vec3 &v = frame.velocity[body], &w = frame.angularVelocity[body];
        switch (settings_.look) {
            case LookKind::speed:
                looks[body] = {scaleColor(v.norm() / fastest_).cast<double>(), 0.7};
                break;
            case LookKind::sleep:
                looks[body] = v.isZero(0.0) && w.isZero(0.0) ? kStillLook : kMovingLook;
                break;
            case LookKind::id:
                looks[body] = {colorOfId(body), 0.7};
                break;
            case LookKind::shaded:
            case LookKind::wireframe:
                break;
        }
    }
    return looks;
}

Image TakePainter::paint(int frame, const std::string& burnedIn)
{
    const bool isDiagnostic =
        settings_.look != LookKind::shaded && settings_.look != LookKind::wireframe;
    BorrowedEngine engine(*this);
    Image image;
    if (settings_.motionBlur < 2) {
        const SceneFrame now = take_.readFrame(frame);
        if (isDiagnostic) engine->setLooks(looksIn(now));
        image = engine->draw(now, camera_, size_[0], size_[1]);
    } else {
        const std::vector<SceneFrame> samples = take_.readSamples(frame);
        if (isDiagnostic) engine->setLooks(looksIn(take_.readFrame(frame)));
        const bool tells = samples.size() > 1;
        const double opens = tells ? samples.front().offset : -kHalfShutter;
        const double closes = tells ? samples.back().offset : kHalfShutter;
        image = Image(size_[0], size_[1]);
        for (int i = 0; i < settings_.motionBlur; ++i) {
            const double offset = opens + (closes - opens) * (i + 0.5) / settings_.motionBlur;
            const SceneFrame moment = sampleAt(samples, offset, take_.info().framesPerSecond);
            addShare(image, engine->draw(moment, camera_, size_[0], size_[1]),
                     1.0f / static_cast<float>(settings_.motionBlur));
        }
    }
    drawLegend(image, legend_);
    if (!burnedIn.empty()) burnIn(image, burnedIn);
    return image;
}

}  // namespace scree
