// E24: contact treats inelastically only what collision has had its chance to bounce. [A26]
// The step is taken phase by phase here, to see which of them gave a pair its impulse.
#include <algorithm>
#include <cmath>

#include "core/dynamics/collision_pass.h"
#include "core/dynamics/contact_graph.h"
#include "core/dynamics/contact_pass.h"
#include "core/dynamics/integrator.h"
#include "tools/verify/experiments.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

/// Normal impulse that a pair has been given so far in the step [N s].
double impulseOf(const PairRecord& pair)
{
    double sum = 0.0;
    for (const PairRecord::NotedImpulse& noted : pair.impulses) {
        sum += noted.seen.impulse.dot(noted.seen.normal);
    }
    return sum;
}

struct Blow {
    bool isRegistered = false;  ///< collision saw the pair interfere
    double excess = 0.0;        ///< over what weight can ask for
};

/// The heaviest impulse of a step, over all weight, that contact gave a pair to which collision
/// gave none. `registersAll`: the control without the set P.
Blow heaviestBlow(World& world, const StepSettings& settings, double dt, bool registersAll)
{
    StepScratch scratch;
    scratch.isWatched = true;
    std::int64_t capped = 0;
    findPairs(world, settings, dt, scratch);
    beginStep(world, settings, dt, scratch);
    resolveCollisions(world, settings, dt, scratch, capped);
    std::vector<double> byCollision(scratch.pairCount);
    std::vector<char> isRegistered(scratch.pairCount);
    for (std::size_t i = 0; i < scratch.pairCount; ++i) {
        byCollision[i] = impulseOf(scratch.pairs[i]);
        isRegistered[i] = scratch.pairs[i].isTouched;
        if (registersAll) scratch.pairs[i].isTouched = true;
    }
    const ContactGraph graph = buildContactGraph(world, settings, dt, scratch);
    addGravity(world, settings, dt);
    resolveContacts(world, graph, settings, dt, scratch, capped);
    double weight = 0.0;
    for (const BodyMass& mass : world.mass) {
        if (mass.isMovable()) weight += settings.gravity.norm() * dt / mass.inverseMass;
    }
    Blow heaviest;
    for (std::size_t i = 0; i < scratch.pairCount; ++i) {
        if (byCollision[i] > 0.0) continue;
        const double excess = impulseOf(scratch.pairs[i]) / weight;
        if (excess > heaviest.excess) heaviest = {isRegistered[i] != 0, excess};
    }
    advancePositions(world, settings, dt);
    return heaviest;
}

struct Tally {
    int unregistered = 0, registered = 0;  ///< drops with an inelastic bounce
};

/// All weight there is, stopped at once, asks for an impulse of one; what is well above has stopped
/// a fall.
constexpr double kBounce = 3.0;

Tally countMissedBounces(const Context& context, int drops, bool registersAll, int iterations)
{
    Tally tally;
    for (int drop = 0; drop < drops; ++drop) {
        ShotRun run(context, "E24_drops",
                    {"shot.seed=" + std::to_string(drop + 1),
                     "solver.collision_iterations=" + std::to_string(iterations)});
        const double rate =
            std::vector{24.0, 60.0, 240.0, 960.0}[static_cast<std::size_t>(drop % 4)];
        bool missed = false, seen = false;
        for (int k = 0; k < rate; ++k) {
            const Blow blow = heaviestBlow(run.world, run.shot.settings, 1.0 / rate, registersAll);
            if (blow.excess < kBounce) continue;
            (blow.isRegistered ? seen : missed) = true;
        }
        tally.unregistered += missed;
        tally.registered += seen;
    }
    return tally;
}

}  // namespace

void runNoMissedBounce(const Context& context, Findings& findings)
{
    if (context.method != "paper") {
        findings.notRun(goal, "random drops", "method scree keeps no set P; its bounces are E28's");
        return;
    }
    const int drops = context.isFull() ? 1000 : 60;
    const std::string name = std::to_string(drops) + " drops of three bodies, 24 to 960 Hz: ";
    const Tally tally = countMissedBounces(context, drops, false, 5);
    findings.equal(must, name + "with a bounce that collision did not see", tally.unregistered, 0);
    findings.report(name + "with one that it saw, not yet approaching", tally.registered, "");
    findings.atLeast(control, name + "the first, without the set P",
                     countMissedBounces(context, drops, true, 5).unregistered, 1.0, "");
    findings.report(name + "the first, without P and one collision iteration",
                    countMissedBounces(context, drops, true, 1).unregistered, "");
}

}  // namespace scree::verify
