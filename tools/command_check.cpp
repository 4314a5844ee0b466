// What can be said of a shot before simulating it.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>

#include "core/base/parallel.h"
#include "io/build_world.h"
#include "io/distance_cache.h"
#include "io/shot_parser.h"
#include "tools/command_line.h"
#include "tools/commands.h"
#include "tools/exit_code.h"

namespace scree {
namespace {

struct CheckOptions {
    std::string shot;
    bool resolved = false, noCache = false;
    std::optional<int> threads;
    std::vector<std::string> overrides;
};

/// What is told of a shape: its first body gives the mass.
struct ShapeUse {
    const Shape* shape = nullptr;
    int bodies = 0;
    double lightest = 0.0, heaviest = 0.0;  ///< of the movable bodies [kg]
};

std::map<std::string, ShapeUse> collectUses(const World& world)
{
    std::map<std::string, ShapeUse> uses;
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        const Shape& shape = world.shapeOf(body);
        if (shape.isPlane) continue;
        ShapeUse& use = uses[shape.name];
        use.shape = &shape;
        ++use.bodies;
        if (!world.mass[body].isMovable()) continue;
        const double mass = 1.0 / world.mass[body].inverseMass;
        use.lightest = use.lightest == 0.0 ? mass : std::min(use.lightest, mass);
        use.heaviest = std::max(use.heaviest, mass);
    }
    return uses;
}

void printShapes(const World& world)
{
    std::printf("%-20s %7s %9s %12s %16s %10s %10s %7s %7s %9s\n", "shape", "bodies", "triangles",
                "volume m3", "mass kg", "thick m", "voxel m", "voxels", "field", "field MB");
    for (const auto& [name, use] : collectUses(world)) {
        const Shape& shape = *use.shape;
        char mass[64] = "-";
        if (use.heaviest > 0.0)
            std::snprintf(mass, sizeof mass,
                          use.lightest == use.heaviest ? "%.4g" : "%.4g ... %.4g", use.lightest,
                          use.heaviest);
        const double spacing = shape.distance.spacing();
        if (shape.distance.solid()) {
            std::printf("%-20s %7d %9ld %12.5g %16s %10.4g %10s %7s %7s %9s\n", name.c_str(),
                        use.bodies, static_cast<long>(shape.mesh.triangles.cols()),
                        shape.unitMass.volume, mass, shape.innerThickness, "-", "-", "exact", "-");
            continue;
        }
        std::printf(
            "%-20s %7d %9ld %12.5g %16s %10.4g %10.4g %7.0f %7s %9.1f\n", name.c_str(), use.bodies,
            static_cast<long>(shape.mesh.triangles.cols()), shape.unitMass.volume, mass,
            shape.innerThickness, spacing, shape.box.longestEdge() / spacing,
            shape.distance.field().nodes.storage == FieldStorage::dense ? "dense" : "bricks",
            1e-6 * static_cast<double>(shape.distance.byteCount()));
    }
}

void printCache(const DistanceCache& cache)
{
    if (cache.folder().empty()) return;
    const DistanceCache::Size size = cache.size();
    std::printf("\ndistance fields: %d from the cache, %d built; \"%s\" holds %d, %.1f MB\n",
                cache.foundCount(), cache.keptCount(), cache.folder().string().c_str(), size.files,
                1e-6 * static_cast<double>(size.bytes));
}

int runCheck(const CheckOptions& options, Console& console)
{
    const Shot shot = parseShot(options.shot, options.overrides);
    if (options.resolved) {
        std::printf("%s", shot.resolvedText.c_str());
        return kExitDone;
    }
    setThreadCount(threadsToUse(options.threads));
    DistanceCache cache(options.noCache ? std::filesystem::path() : defaultCacheFolder());
    const World world = buildWorld(shot, &cache);
    if (!cache.problem().empty()) console.warning("distance field cache: " + cache.problem());
    std::size_t movable = 0;
    for (const BodyMass& mass : world.mass) movable += mass.isMovable();
    std::printf("%s: frames %d-%d at %g a second, %zu bodies, %zu of them movable\n\n",
                shot.name.c_str(), shot.firstFrame, shot.lastFrame, shot.framesPerSecond,
                world.bodyCount(), movable);
    printShapes(world);
    printCache(cache);
    return kExitDone;
}

}  // namespace

Command addCheckCommand(CLI::App& program)
{
    auto options = std::make_shared<CheckOptions>();
    CLI::App* command =
        program.add_subcommand("check", "Say what a shot holds, without simulating");
    command->add_option("SHOT", options->shot, "The shot file")->required();
    command->add_flag("--resolved", options->resolved,
                      "Print the shot with all its defaults instead");
    command->add_option("--threads", options->threads, "Number of threads [all]");
    command->add_flag("--no-cache", options->noCache,
                      "Build every distance field anew and keep none");
    command->add_option("--set", options->overrides, "KEY=VALUE: override a key of the shot")
        ->type_name("KEY=VALUE")
        ->expected(1)
        ->take_all();
    command->footer("Example:\n  scree check shots/rings_100.toml");
    return {command, [options](Console& console) { return runCheck(*options, console); }};
}

}  // namespace scree
