#include "tools/verify/shot_run.h"

#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/dynamics/integrator.h"
#include "core/picture/camera_motion.h"
#include "io/build_world.h"
#include "io/shot_parser.h"
#include "io/shot_tree.h"
#include "render/camera.h"
#include "render/look.h"
#include "render/png_writer.h"
#include "render/rasterizer.h"
#include "tools/stop_signals.h"

namespace scree::verify {
namespace {

constexpr const char* kOutcomeOfStop = "the experiments were not run to their end";
constexpr int kPictureWidth = 640, kPictureHeight = 400;

/// Half width of the quads that stand for planes; the rasteriser draws them without end [m].
constexpr double kPlaneHalfWidth = 50.0;

std::vector<std::string> withContext(const Context& context, std::vector<std::string> overrides)
{
    overrides.push_back("solver.method=" + context.method);
    if (context.seed != 0) overrides.push_back("shot.seed=" + std::to_string(context.seed));
    return overrides;
}

Shot readShot(const Context& context, const std::string& name,
              const std::vector<std::string>& overrides,
              const std::function<void(StepSettings&)>& change)
{
    heedStop(kOutcomeOfStop);
    const std::string path = (context.shots / (name + ".toml")).string();
    Shot shot = parseShot(path, withContext(context, overrides));
    if (change) change(shot.settings);
    return shot;
}

Shot readChanged(const Context& context, const ChangedShot& changed,
                 const std::vector<std::string>& overrides)
{
    heedStop(kOutcomeOfStop);
    const std::string text =
        "scree = 1\nextends = \"" + changed.name + ".toml\"\n" + changed.changes;
    const std::string path = (context.shots / (changed.name + "_changed.toml")).string();
    return parseShotText(text, path, withContext(context, overrides));
}

std::vector<Look> looksOf(const Shot& shot, const SceneDescription& scene)
{
    std::vector<Look> looks;
    for (const SceneBody& body : scene.bodies) {
        Look look;
        for (const ShotMaterial& material : shot.materials) {
            if (material.material.name == body.material)
                look = {material.color, material.roughness};
        }
        looks.push_back(look);
    }
    return variedLooks(scene, looks);
}

/// A run without numbers has none to judge, and much of what is counted would count nothing.
void refuseNonFinite(const World& world, const StepReport& report)
{
    if (report.nonFinite.empty()) return;
    throw Error(ErrorKind::qualityLimit, "'" + world.info[report.nonFinite.front()].name +
                                             "' is no longer finite after " +
                                             nameOf(report.nonFinitePhase));
}

}  // namespace

ShotRun::ShotRun(const Context& context, const std::string& name,
                 const std::vector<std::string>& overrides,
                 const std::function<void(StepSettings&)>& change)
    : ShotRun(readShot(context, name, overrides, change))
{
}

ShotRun::ShotRun(const Context& context, const ChangedShot& changed,
                 const std::vector<std::string>& overrides)
    : ShotRun(readChanged(context, changed, overrides))
{
}

ShotRun::ShotRun(Shot asRead)
    : shot(std::move(asRead)), world(buildWorld(shot)), start(world), stepper(shot.settings)
{
}

void ShotRun::advance(double seconds, double stepsPerSecond,
                      const std::function<void(const StepReport&, double)>& look)
{
    const double dt = 1.0 / stepsPerSecond;
    const int steps = static_cast<int>(std::lround(seconds * stepsPerSecond));
    for (int k = 1; k <= steps; ++k) {
        heedStop(kOutcomeOfStop);
        const StepReport report = stepper.step(world, dt);
        refuseNonFinite(world, report);
        if (look) look(report, k * dt);
    }
}

void ShotRun::advanceFrames(int count, const std::function<void(const FrameReport&)>& look,
                            const std::function<void(const World&, double)>& lookAtStep)
{
    for (int frame = 0; frame < count; ++frame) {
        const FrameReport report =
            stepper.advanceFrame(world, 1.0 / shot.framesPerSecond, stopRequested, lookAtStep);
        heedStop(kOutcomeOfStop);
        refuseNonFinite(world, report.sum);
        if (look) look(report);
    }
}

SceneDescription ShotRun::describe() const
{
    return describeScene(shot, world, kPlaneHalfWidth);
}

SceneFrame ShotRun::capture() const
{
    return captureFrame(shot, world);
}

BodyId ShotRun::body(const std::string& name) const
{
    for (std::size_t b = 0; b < world.info.size(); ++b) {
        if (world.info[b].name == name) return static_cast<BodyId>(b);
    }
    throw Error(ErrorKind::internal, "shot " + shot.name + " has no body " + name);
}

Method methodOf(const Context& context)
{
    return context.method == "scree" ? Method::scree : Method::paper;
}

const std::vector<std::string>& withDefaultSteps()
{
    static const std::vector<std::string> overrides = {"solver.substeps.min=1",
                                                       "solver.substeps.max=256"};
    return overrides;
}

std::vector<std::string> asExactSolids(const std::vector<std::string>& shapes)
{
    std::vector<std::string> overrides;
    for (const std::string& shape : shapes) {
        overrides.push_back("shape." + shape + ".collide=\"exact\"");
    }
    return overrides;
}

std::string setVector(const std::string& key, const Vec3& value)
{
    return key + "=[" + toTomlText(value.x()) + ", " + toTomlText(value.y()) + ", " +
           toTomlText(value.z()) + "]";
}

std::string setNumber(const std::string& key, double value)
{
    return key + "=" + toTomlText(value);
}

Vec3 spinOf(const World& world, BodyId body)
{
    return angularVelocity(world.motion[body], world.mass[body]);
}

double largestVertexShift(const World& before, const World& after, BodyId body)
{
    const Points& points = after.shapeOf(body).assetMesh.points;
    const Pose was = before.worldFromAsset(body), is = after.worldFromAsset(body);
    double largest = 0.0;
    for (Eigen::Index v = 0; v < points.cols(); ++v) {
        const Vec3 p = points.col(v);
        largest = larger(largest, (is * p - was * p).norm());
    }
    return largest;
}

double lowestVertex(const World& world, BodyId body)
{
    const Points& points = world.shapeOf(body).assetMesh.points;
    const Pose pose = world.worldFromAsset(body);
    double lowest = 1e300;
    for (Eigen::Index v = 0; v < points.cols(); ++v) {
        const Vec3 p = points.col(v);
        lowest = smaller(lowest, (pose * p).y());
    }
    return lowest;
}

std::string levelsInAFrame(ShotRun& run)
{
    LastStep last;
    run.stepper.observe(&last);
    run.advanceFrames(1);
    run.stepper.observe(nullptr);
    std::string levels;
    for (std::size_t b = 0; b < run.world.bodyCount(); ++b) {
        if (run.world.mass[b].isMovable()) levels += std::to_string(last.seen.level[b]);
    }
    return levels;
}

void addPicture(const Context& context, const ShotRun& run, const std::string& caption,
                Findings& findings, bool isWireframe)
{
    if (!context.wantsPictures) return;
    const SceneDescription scene = run.describe();
    const SceneCamera& from = run.shot.cameras.at(0);
    const Camera camera{from.eye, from.target, upOf(from, run.shot.zUp), from.fovDegrees};
    RasterSettings settings;
    settings.wireframe = isWireframe;
    Rasterizer rasterizer(scene, looksOf(run.shot, scene), settings);
    const Image image = rasterizer.draw(run.capture(), camera, kPictureWidth, kPictureHeight);
    findings.pictures.push_back({caption, encodePng(image)});
}

}  // namespace scree::verify
