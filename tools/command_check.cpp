// What can be said of a shot before simulating it.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/base/parallel.h"
#include "core/geometry/shape_report.h"
#include "core/math/rotation.h"
#include "io/build_world.h"
#include "io/shape_cache.h"
#include "io/shot_parser.h"
#include "tools/birth_forecast.h"
#include "tools/command_line.h"
#include "tools/commands.h"
#include "tools/exit_code.h"
#include "tools/parts_progress.h"
#include "tools/repair_report.h"
#include "tools/rolling_advice.h"
#include "tools/run_estimate.h"
#include "tools/shot_warnings.h"
#include "tools/start_rule.h"
#include "tools/stop_signals.h"
#include "tools/stoppable_build.h"

namespace scree {
namespace {

constexpr double kMostEstimateSeconds = 20.0;
constexpr std::size_t kMostShapesPrinted = 24;
constexpr int kParts = 5;  ///< the world, its shapes, overlaps, warnings, the estimate

struct CheckOptions {
    std::string shot, progress = "auto";
    bool resolved = false, json = false, noCache = false, allShapes = false;
    int estimateFrames = 3;
    std::optional<int> threads;
    std::vector<std::string> overrides;
    ImportLimits importLimits;
};

/// What is told of a shape: its first body gives the mass.
struct ShapeUse {
    const Shape* shape = nullptr;
    ShapeReport report;
    int bodies = 0;
    double lightest = 0.0, heaviest = 0.0;  ///< of the movable bodies [kg]
};

/// Everything the command says, as values.
struct ShotReport {
    std::size_t bodies = 0, movable = 0;
    std::map<std::string, ShapeUse> shapes;
    std::vector<std::string> repairs, notes, warnings;
    std::vector<StartOverlap> overlaps;
    RunEstimate estimate;
};

std::map<std::string, ShapeUse> collectUses(const World& world)
{
    std::map<std::string, ShapeUse> uses;
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        const Shape& shape = world.shapeOf(body);
        if (shape.isPlane) continue;
        ShapeUse& use = uses[shape.name];
        if (!use.shape) use.report = reportShape(shape);
        use.shape = &shape;
        ++use.bodies;
        const double mass = world.massWhenFree(body);
        if (mass == 0.0) continue;
        use.lightest = use.lightest == 0.0 ? mass : std::min(use.lightest, mass);
        use.heaviest = std::max(use.heaviest, mass);
    }
    return uses;
}

ShotReport examine(const Shot& shot, const World& world, int estimateFrames,
                   PartsProgress& progress)
{
    ShotReport report;
    report.bodies = world.bodyCount();
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        report.movable += world.massWhenFree(body) > 0.0;
    }
    report.shapes = collectUses(world);
    report.repairs = repairsOf(world);
    progress.partDone();
    report.notes = rollingAdvice(shot, world);
    for (const std::string& note : notesBeforeStart(shot)) report.notes.push_back(note);
    report.overlaps = findStartOverlaps(world, shot.penetrationWarn);
    progress.partDone();
    report.warnings = warningsBeforeStart(shot, world);
    for (const std::string& late : foretellBirths(shot, world)) report.warnings.push_back(late);
    progress.partDone();
    report.estimate = estimateRun(shot, world, estimateFrames, kMostEstimateSeconds, stopRequested);
    progress.partDone();
    return report;
}

/// Mass, and inertia of the body with the greatest mass.
std::string massText(const ShapeUse& use)
{
    if (use.heaviest == 0.0) return "immovable";
    char mass[64], inertia[96];
    std::snprintf(mass, sizeof mass,
                  use.lightest == use.heaviest ? "mass %.4g kg" : "mass %.4g ... %.4g kg",
                  use.lightest, use.heaviest);
    const MassProperties& unit = use.shape->unitMass;
    const Vec3 moments = unit.moments * (use.heaviest / unit.volume);
    std::snprintf(inertia, sizeof inertia, ", inertia %.4g %.4g %.4g kg m2", moments[0], moments[1],
                  moments[2]);
    return std::string(mass) + inertia;
}

void printShape(const std::string& name, const ShapeUse& use)
{
    const Shape& shape = *use.shape;
    const ShapeReport& report = use.report;
    std::printf("%s: %d %s, %s\n", name.c_str(), use.bodies, use.bodies == 1 ? "body" : "bodies",
                massText(use).c_str());
    std::printf("  mesh    closed, outward; %zu triangles, %zu points, %d part%s, %.4g m long\n",
                report.triangles, report.points, report.parts, report.parts == 1 ? "" : "s",
                report.longestEdge);
    std::printf("  volume  %.5g m3 by the mesh, %.5g m3 by the field (%+.2g %%)\n",
                report.meshVolume, report.fieldVolume,
                100.0 * (report.fieldVolume / report.meshVolume - 1.0));
    if (shape.distance.solid()) {
        std::printf("  walls   %.4g m at the thinnest; exact solid, no voxels\n",
                    shape.innerThickness);
    } else {
        const double spacing = shape.distance.spacing();
        std::printf("  walls   %.4g m at the thinnest, %.1f voxels of %.4g m, %.0f along the box\n",
                    shape.innerThickness, shape.innerThickness / spacing, spacing,
                    report.longestEdge / spacing);
        std::printf(
            "  field   %s, %.1f MB\n",
            shape.distance.field().nodes.storage == FieldStorage::dense ? "dense" : "bricks",
            1e-6 * static_cast<double>(shape.distance.byteCount()));
    }
    std::printf("  edges   %d sharper than 40 degrees, the sharpest %.0f; normals %s\n",
                report.sharpEdges, report.sharpestEdge * 180.0 / kPi,
                shape.usesTrueNormals ? "of the mesh" : "of the field");
    if (!shape.showsAllTurns())
        std::printf("  round   %s\n", shape.isBall() ? "a ball" : "about an axis");
}

/// Of many shapes, as of a building in shards: what they range over, and which to look at first.
void printShapesTogether(const std::map<std::string, ShapeUse>& shapes)
{
    struct Extreme {
        double value = 0.0;
        std::string of;
    };
    std::optional<Extreme> lightest, heaviest, thinnest, coarsest, farthestOff;
    const auto note = [](std::optional<Extreme>& extreme, double value, const std::string& name,
                         const auto& isBeyond) {
        if (!extreme || isBeyond(value, extreme->value)) extreme = {value, name};
    };
    std::size_t triangles = 0;
    for (const auto& [name, use] : shapes) {
        const Shape& shape = *use.shape;
        triangles += use.report.triangles;
        if (use.heaviest > 0.0) {
            note(lightest, use.lightest, name, std::less());
            note(heaviest, use.heaviest, name, std::greater());
        }
        note(thinnest, shape.innerThickness, name, std::less());
        const double off = use.report.fieldVolume / use.report.meshVolume - 1.0;
        note(farthestOff, 100.0 * off, name,
             [](double a, double b) { return std::abs(a) > std::abs(b); });
        if (!shape.distance.solid())
            note(coarsest, shape.innerThickness / shape.distance.spacing(), name, std::less());
    }
    const auto print = [](const char* label, const std::optional<Extreme>& extreme,
                          const char* format) {
        if (!extreme) return;
        std::printf("  %s", label);
        std::printf(format, extreme->value);
        std::printf(": \"%s\"\n", extreme->of.c_str());
    };
    std::printf("%zu shapes of %zu triangles; each of them with --shapes\n", shapes.size(),
                triangles);
    print("lightest  ", lightest, "%.4g kg");
    print("heaviest  ", heaviest, "%.4g kg");
    print("thinnest  ", thinnest, "a wall of %.4g m");
    print("coarsest  ", coarsest, "%.1f voxels across the thinnest wall");
    print("volume    ", farthestOff, "by the field %+.2g %% of that by the mesh, at most");
}

void printList(const char* title, const std::vector<std::string>& lines)
{
    if (lines.empty()) return;
    std::printf("\n%s\n", title);
    for (const std::string& line : lines) std::printf("  %s\n", line.c_str());
}

void printCache(const ShapeCache& cache)
{
    if (cache.folder().empty()) return;
    const ShapeCache::Size size = cache.size();
    std::printf(
        "\ndistance fields and repaired solids: %d from the cache, %d made; \"%s\" holds %d, %.1f "
        "MB\n",
        cache.foundCount(), cache.keptCount(), cache.folder().string().c_str(), size.files,
        1e-6 * static_cast<double>(size.bytes));
}

void printText(const Shot& shot, const World& world, const ShotReport& report,
               const ShapeCache& cache, bool allShapes)
{
    std::printf("%s: frames %d-%d at %g a second, %zu %s, %zu of them movable\n\n",
                shot.name.c_str(), shot.firstFrame, shot.lastFrame, shot.framesPerSecond,
                report.bodies, report.bodies == 1 ? "body" : "bodies", report.movable);
    if (allShapes || report.shapes.size() <= kMostShapesPrinted) {
        for (const auto& [name, use] : report.shapes) printShape(name, use);
    } else {
        printShapesTogether(report.shapes);
    }
    printList("repaired", report.repairs);
    printList("overlaps at the start", describeWorst(report.overlaps, world));
    printList("notes", report.notes);
    printList("warnings", report.warnings);
    const RunEstimate& estimate = report.estimate;
    std::printf("\nestimate\n  disk %.1f MB, memory %.0f MB", 1e-6 * estimate.diskBytes,
                1e-6 * estimate.memoryBytes);
    if (estimate.framesTried > 0) {
        const std::string toCome =
            estimate.bodiesToCome > 0
                ? ", with " + std::to_string(estimate.bodiesToCome) + " bodies that come later"
                : "";
        std::printf(
            "\n  time %s wall, %s of processors, if the shot goes on as its first %d frames "
            "(%d steps)%s; a heap that forms later costs more",
            describeDuration(estimate.wallSeconds).c_str(),
            describeDuration(estimate.cpuSeconds).c_str(), estimate.framesTried,
            estimate.stepsTried, toCome.c_str());
    }
    std::printf("\n");
    printCache(cache);
}

/// What a repair put behind the mesh [m]; 0 if it was another.
double behindBy(MeshRepair repair, const ShapeRepairs& done)
{
    return done.asked == repair ? done.behind : 0.0;
}

nlohmann::ordered_json toJson(const ShapeUse& use)
{
    const Shape& shape = *use.shape;
    const ShapeReport& report = use.report;
    const MeshDeviation& apart = shape.repairs.drawnToColliding;
    return {{"bodies", use.bodies},
            {"triangles", report.triangles},
            {"points", report.points},
            {"parts", report.parts},
            {"closed", true},
            {"volume_m3", report.meshVolume},
            {"field_volume_m3", report.fieldVolume},
            {"lightest_kg", use.lightest},
            {"heaviest_kg", use.heaviest},
            {"moments_m5",
             {shape.unitMass.moments[0], shape.unitMass.moments[1], shape.unitMass.moments[2]}},
            {"longest_edge_m", report.longestEdge},
            {"thinnest_m", shape.innerThickness},
            {"exact", shape.distance.solid() != nullptr},
            {"voxel_m", shape.distance.spacing()},
            {"sharp_edges", report.sharpEdges},
            {"sharpest_degrees", report.sharpestEdge * 180.0 / kPi},
            {"round", shape.isBall()          ? "ball"
                      : shape.showsAllTurns() ? "no"
                                              : "axis"},
            {"merged_points", shape.repairs.harmless.mergedPoints},
            {"dropped_triangles", shape.repairs.harmless.droppedTriangles},
            {"flipped_edges", shape.repairs.harmless.flippedEdges},
            {"turned", shape.repairs.harmless.isTurned},
            {"remeshed", shape.repairs.voxel > 0.0},
            {"ground_depth_m", behindBy(MeshRepair::ground, shape.repairs)},
            {"room_wall_m", behindBy(MeshRepair::room, shape.repairs)},
            {"solidified_m", behindBy(MeshRepair::solidify, shape.repairs)},
            {"collision_mesh", shape.repairs.hasCollisionMesh},
            {"drawn_to_colliding_m", apart.distance},
            {"drawn_to_colliding_at", {apart.place[0], apart.place[1], apart.place[2]}},
            {"drawn_to_colliding_of", apart.isOnFirst ? "drawn" : "colliding"}};
}

void printJson(const Shot& shot, const World& world, const ShotReport& report)
{
    nlohmann::ordered_json shapes = nlohmann::ordered_json::object();
    for (const auto& [name, use] : report.shapes) shapes[name] = toJson(use);
    nlohmann::ordered_json overlaps = nlohmann::ordered_json::array();
    for (const StartOverlap& overlap : report.overlaps) {
        overlaps.push_back({{"a", world.info[overlap.a].name},
                            {"b", world.info[overlap.b].name},
                            {"depth_m", overlap.depth},
                            {"ratio", overlap.ratio},
                            {"through_wall", overlap.isThroughWall}});
    }
    const nlohmann::ordered_json json = {
        {"name", shot.name},
        {"frames", {shot.firstFrame, shot.lastFrame}},
        {"bodies", report.bodies},
        {"movable_bodies", report.movable},
        {"shapes", shapes},
        {"repairs", report.repairs},
        {"overlaps", overlaps},
        {"notes", report.notes},
        {"warnings", report.warnings},
        {"estimate",
         {{"frames_tried", report.estimate.framesTried},
          {"steps_tried", report.estimate.stepsTried},
          {"wall_s", report.estimate.wallSeconds},
          {"cpu_s", report.estimate.cpuSeconds},
          {"bodies_to_come", report.estimate.bodiesToCome},
          {"disk_bytes", report.estimate.diskBytes},
          {"memory_bytes", report.estimate.memoryBytes}}},
    };
    std::printf("%s\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
}

int checkShot(const CheckOptions& options, Console& console)
{
    const ProgressMode progressMode = parseProgressMode(options.progress);
    const Shot shot = parseShot(options.shot, options.overrides, options.importLimits);
    if (options.resolved) {
        std::printf("%s", shot.resolvedText.c_str());
        return kExitDone;
    }
    setThreadCount(threadsToUse(options.threads));
    ShapeCache cache(options.noCache ? std::filesystem::path() : defaultCacheFolder());
    PartsProgress progress(console, progressMode, kParts);
    const World world = buildStoppably(shot, cache, console);
    progress.partDone();
    const ShotReport report = examine(shot, world, options.estimateFrames, progress);
    heedEarlySignals(console);
    if (options.json)
        printJson(shot, world, report);
    else
        printText(shot, world, report, cache, options.allShapes);
    // What sim would refuse, check refuses too.
    const bool begins = foretellStartRule(shot, world, report.overlaps, console);
    if (!begins) return exitCodeFor(ErrorKind::badInput);
    if (report.estimate.complaint.empty()) return kExitDone;
    console.error(report.estimate.complaint);
    return exitCodeFor(ErrorKind::qualityLimit);
}

}  // namespace

Command addCheckCommand(CLI::App& program)
{
    auto options = std::make_shared<CheckOptions>();
    CLI::App* command =
        program.add_subcommand("check", "Say all that can be said of a shot before simulating it");
    command->add_option("SHOT", options->shot, "The shot file")->required();
    CLI::Option* resolved = command->add_flag("--resolved", options->resolved,
                                              "Print the shot with all its defaults instead");
    command->add_flag("--json", options->json, "As one JSON object")->excludes(resolved);
    command
        ->add_flag("--shapes", options->allShapes,
                   "Each shape in full also where there are more than " +
                       std::to_string(kMostShapesPrinted))
        ->excludes(resolved);
    command
        ->add_option("--estimate", options->estimateFrames,
                     "Frames simulated to estimate the time [3]; 0 for none")
        ->check(CLI::Range(0, 1000));
    addImportLimits(*command, options->importLimits);
    command->add_option("--threads", options->threads, "Number of threads [all]");
    addNoCache(*command, options->noCache);
    addOverrides(*command, options->overrides);
    addProgress(*command, options->progress);
    command->footer(
        "Ends with 65 when sim would refuse the shot, also for bodies that overlap where it "
        "begins.\n"
        "Example:\n  scree check shots/rings_100.toml");
    return {command, [options](Console& console) { return checkShot(*options, console); }};
}

}  // namespace scree
