// E26: what shock propagation buys. E27: tall and heavy stacks at one step a frame. [A45]
#include <cmath>
#include <functional>

#include "tools/verify/experiments.h"
#include "tools/verify/heap_record.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

struct Stand {
    double sink = 0.0, drift = 0.0;  // of the body that was highest [m], of any [m]
};

constexpr double kAsChosen = 0.0;  // a rate: the steps that the shot's settings choose [1/s]

std::string nameOfRate(double rate)
{
    return rate == kAsChosen ? "steps as by default" : shortNumber(rate) + " Hz";
}

void advance(ShotRun& run, double seconds, double rate, const std::function<void()>& look)
{
    if (rate == kAsChosen) {
        run.advanceFrames(static_cast<int>(std::lround(seconds * run.shot.framesPerSecond)),
                          [&](const FrameReport&) { look(); });
    } else {
        run.advance(seconds, rate, [&](const StepReport&, double) { look(); });
    }
}

Stand standFor(ShotRun& run, double seconds, double rate, double enough)
{
    BodyId top = -1;
    for (std::size_t b = 0; b < run.start.bodyCount(); ++b) {
        if (!run.start.mass[b].isMovable()) continue;
        const double height = run.start.motion[b].position.y();
        if (top < 0 || height > run.start.motion[top].position.y()) top = static_cast<BodyId>(b);
    }
    Stand result;
    // A stack that has clearly fallen is not watched further: tumbling takes long.
    for (int quarter = 0; quarter < 4.0 * seconds && result.drift < enough; ++quarter) {
        advance(run, 0.25, rate, [&] {
            for (std::size_t b = 0; b < run.world.bodyCount(); ++b) {
                const Vec3 moved = run.world.motion[b].position - run.start.motion[b].position;
                result.drift = larger(result.drift, std::hypot(moved.x(), moved.z()));
            }
        });
        result.sink =
            std::abs(run.start.motion[top].position.y() - run.world.motion[top].position.y());
        if (result.sink > enough) break;
    }
    return result;
}

ShotRun stackOf(const Context& context, int cubes, bool hasShock, int sweeps)
{
    const std::string key = context.method == "scree" ? "contact_sweeps" : "contact_iterations";
    return ShotRun(context, "E04_stack_10",
                   {"body.cube.grid.count=[1, " + std::to_string(cubes) + ", 1]",
                    setVector("body.cube.position", {0.0, 0.5 * cubes, 0.0}),
                    "solver." + key + "=" + std::to_string(sweeps),
                    std::string("solver.shock_propagation=") + (hasShock ? "true" : "false")});
}

/// Whether the stack is where it was, to 1 mm, after 2 s: neither sunk nor leaning.
bool standsStill(ShotRun& run)
{
    const Stand result = standFor(run, 2.0, 240.0, 1e-3);
    return larger(result.sink, result.drift) <= 1e-3;
}

/// The fewest sweeps of `tried` with which a stack of n cubes stands still; no number if all are
/// too few.
double sweepsNeeded(const Context& context, int cubes, bool hasShock, std::vector<int> tried)
{
    for (int sweeps : tried) {
        ShotRun run = stackOf(context, cubes, hasShock, sweeps);
        if (standsStill(run)) return sweeps;
    }
    return std::nan("");
}

/// Twenty cubes up to 5 cm off the axis: without shock, what leans falls.
void offTheAxis(const Context& context, Findings& findings)
{
    const auto drift = [&](int sweeps, const std::string& hasShock) {
        ShotRun run(context, "E04_stack_20",
                    {"solver.contact_iterations=" + std::to_string(sweeps),
                     "solver.shock_propagation=" + hasShock});
        return standFor(run, 2.0, 240.0, 0.25).drift;
    };
    const std::string name = "twenty offset cubes, 2 s: ";
    const double with = drift(10, "true");
    findings.atMost(must, name + "drift, ten sweeps with shock", with, 0.02, "m");
    findings.atLeast(must, name + "fifty without shock drift so many times as far",
                     drift(50, "false") / with, 5.0, "-",
                     "five times the sweeps do not replace it");
}

/// The paper's comparison with earlier work: a thousand cubes fall into a bin.
void cubesInABin(const Context& context, Findings& findings)
{
    const std::string name = "cubes_1000_bin";
    const std::optional<HeapRecord> record = largeTake(context, name, findings);
    if (!record) return;
    const Weight weight = context.method == "scree" ? must : goal;
    addCommonRows(*record, name, goal, findings);
    const std::vector<double> speeds = speedsAt(*record, record->frames.size() - 1);
    findings.atMost(weight, name + ": 95th percentile of the speed at the end",
                    quantile(speeds, 0.95), 0.01, "m/s");
    findings.atMost(weight, name + ": fastest at the end", quantile(speeds, 1.0), 0.01, "m/s");
    addTakePictures(context, name, {1.0}, false, name, findings);
}

/// The experiment's table. Without shock up to two hundred sweeps are tried.
void tableOfSweeps(const Context& context, Findings& findings)
{
    const bool isScree = context.method == "scree";
    const std::vector<int> sizes = context.isFull() ? std::vector{5, 10, 20} : std::vector{20};
    for (int cubes : sizes) {
        const std::string name = std::to_string(cubes) + " cubes: ";
        const double with = sweepsNeeded(
            context, cubes, true,
            context.isFull() || isScree ? std::vector{1, 2, 5, 10, 20} : std::vector{20});
        findings.atMost(must, name + "contact sweeps for 1 mm with shock", with, 20, "");
        if (!context.isFull() && !isScree) continue;
        const double without = sweepsNeeded(context, cubes, false, {1, 2, 5, 10, 20, 50, 100, 200});
        findings.report(name + "contact sweeps for 1 mm without shock", without, "",
                        std::isnan(without) ? "more than 200" : "");
        if (cubes != 20) continue;
        findings.atLeast(departure, name + "sweeps without shock over with it", without / with, 5.0,
                         "-",
                         isScree ? "stacks are solved to the end whatever sweeps are allowed: "
                                   "shock has nothing left to buy"
                                 : "straight above each other they hardly lean: shock buys little");
    }
}

/// With the steps and sweeps that method scree has by default.
void standsByDefault(const Context& context, Findings& findings)
{
    for (int cubes : {5, 10, 20}) {
        ShotRun run(context, "E04_stack_10",
                    {"body.cube.grid.count=[1, " + std::to_string(cubes) + ", 1]",
                     setVector("body.cube.position", {0.0, 0.5 * cubes, 0.0})});
        const Stand stand = standFor(run, 2.0, 240.0, 1e-3);
        findings.atMost(must, std::to_string(cubes) + " cubes, 2 s: top sinks or any drifts",
                        larger(stand.sink, stand.drift), 1e-3, "m");
    }
    ShotRun offset(context, "E04_stack_20");
    findings.atMost(must, "twenty offset cubes, 2 s: drift",
                    standFor(offset, 2.0, 240.0, 0.25).drift, 0.02, "m");
}

/// The ring of E6 as a shot: largest shift of any domino. Four seconds are the whole of it.
void ringOfDominoes(const Context& context, Weight weight, Findings& findings)
{
    const bool isAll = context.isFull() && context.method == "scree";
    for (double rate : isAll ? std::vector{24.0, kAsChosen, 240.0} : std::vector{kAsChosen}) {
        ShotRun ring(context, "../dominoes");
        double moved = 0.0;
        advance(ring, 4.0, rate, [&] {
            for (std::size_t b = 0; b < ring.world.bodyCount(); ++b) {
                const auto body = static_cast<BodyId>(b);
                if (!ring.world.mass[b].isMovable()) continue;
                moved = larger(moved, largestVertexShift(ring.start, ring.world, body));
            }
        });
        findings.atMost(weight, "ring of dominoes, " + nameOfRate(rate) + ", 4 s: largest shift",
                        moved, 0.05, "m",
                        "it settles on its few points; standing means not falling");
        if (rate == kAsChosen)
            addPicture(context, ring, "The ring of dominoes after 4 s", findings);
    }
}

}  // namespace

void runWhatShockBuys(const Context& context, Findings& findings)
{
    tableOfSweeps(context, findings);
    if (context.method == "scree")
        standsByDefault(context, findings);
    else
        offTheAxis(context, findings);
}

void runTallAndHeavy(const Context& context, Findings& findings)
{
    const Weight weight = context.method == "scree" ? must : goal;
    struct Case {
        const char* shot;
        const char* name;
        std::vector<std::string> overrides;
    };
    for (const Case& c : {Case{"E27_pair", "1000 : 1", {}},
                          Case{"E27_pair", "10 000 : 1", {"body.heavy.mass=10000.0"}},
                          Case{"E27_heavy_top", "ten with a 100 x heavier top", {}},
                          Case{"E27_stack_40", "stack of 40", {}}}) {
        for (double rate : {24.0, kAsChosen, 240.0}) {
            if (!context.isFull() && rate > 24.0) continue;
            std::vector<std::string> overrides = c.overrides;
            const std::vector<std::string>& usual = withDefaultSteps();
            if (rate == kAsChosen) overrides.insert(overrides.end(), usual.begin(), usual.end());
            ShotRun run(context, c.shot, overrides);
            const Stand result = standFor(run, 10.0, rate, 1.0);
            const std::string name = std::string(c.name) + ", " + nameOfRate(rate) + ": ";
            findings.atMost(weight, name + "top sinks", result.sink, 1e-3, "m");
            findings.atMost(weight, name + "drift", result.drift, 5e-3, "m");
        }
    }
    ringOfDominoes(context, weight, findings);
    if (context.isFull()) cubesInABin(context, findings);
}

}  // namespace scree::verify
