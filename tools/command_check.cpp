// What can be said of a shot before simulating it.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>

#include "core/base/parallel.h"
#include "io/build_world.h"
#include "io/shot_parser.h"
#include "tools/command_line.h"
#include "tools/commands.h"
#include "tools/exit_code.h"

namespace scree {
namespace {

struct CheckOptions {
    std::string shot;
    bool resolved = false;
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
    std::printf("%-20s %7s %9s %12s %16s %10s %10s %7s\n", "shape", "bodies", "triangles",
                "volume m3", "mass kg", "thick m", "voxel m", "voxels");
    for (const auto& [name, use] : collectUses(world)) {
        const Shape& shape = *use.shape;
        char mass[64] = "-";
        if (use.heaviest > 0.0)
            std::snprintf(mass, sizeof mass,
                          use.lightest == use.heaviest ? "%.4g" : "%.4g ... %.4g", use.lightest,
                          use.heaviest);
        const double spacing = shape.distance.spacing();
        if (shape.distance.solid()) {
            std::printf("%-20s %7d %9ld %12.5g %16s %10.4g %10s %7s\n", name.c_str(), use.bodies,
                        static_cast<long>(shape.mesh.triangles.cols()), shape.unitMass.volume, mass,
                        shape.innerThickness, "exact", "-");
            continue;
        }
        std::printf("%-20s %7d %9ld %12.5g %16s %10.4g %10.4g %7.0f\n", name.c_str(), use.bodies,
                    static_cast<long>(shape.mesh.triangles.cols()), shape.unitMass.volume, mass,
                    shape.innerThickness, spacing, shape.box.longestEdge() / spacing);
    }
}

int runCheck(const CheckOptions& options)
{
    const Shot shot = parseShot(options.shot, options.overrides);
    if (options.resolved) {
        std::printf("%s", shot.resolvedText.c_str());
        return kExitDone;
    }
    setThreadCount(threadsToUse(options.threads));
    const World world = buildWorld(shot);
    std::size_t movable = 0;
    for (const BodyMass& mass : world.mass) movable += mass.isMovable();
    std::printf("%s: frames %d-%d at %g a second, %zu bodies, %zu of them movable\n\n",
                shot.name.c_str(), shot.firstFrame, shot.lastFrame, shot.framesPerSecond,
                world.bodyCount(), movable);
    printShapes(world);
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
    command->add_option("--set", options->overrides, "KEY=VALUE: override a key of the shot")
        ->type_name("KEY=VALUE")
        ->expected(1)
        ->take_all();
    command->footer("Example:\n  scree check shots/rings_100.toml");
    return {command, [options](Console&) { return runCheck(*options); }};
}

}  // namespace scree
