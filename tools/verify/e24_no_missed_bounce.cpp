// E24: contact treats inelastically only what collision has had its chance to bounce. [A26]
// The step of method `paper` is taken phase by phase here, to see which of them gave a pair its
// impulse.
#include <array>
#include <map>
#include <utility>

#include "core/base/random.h"
#include "core/diagnostics/step_observer.h"
#include "core/dynamics/collision_pass.h"
#include "core/dynamics/contact_graph.h"
#include "core/dynamics/contact_pass.h"
#include "core/dynamics/integrator.h"
#include "core/math/rotation.h"
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

/// Which drops: in short those among which a step once took what moves after its blow for at rest.
struct Drops {
    std::uint64_t begin, end;

    explicit Drops(const Context& context)
        : begin(context.isFull() ? 0 : 200), end(context.isFull() ? 1000 : 300)
    {
    }
    std::string name() const
    {
        return std::to_string(end - begin) + " drops of three bodies, 24 to 960 Hz";
    }
};

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
    findPairs(world, settings, dt, scratch);
    beginStep(world, settings, dt, scratch);
    resolveCollisions(world, settings, dt, scratch);
    std::vector<double> byCollision(scratch.pairCount);
    std::vector<char> isRegistered(scratch.pairCount);
    for (std::size_t i = 0; i < scratch.pairCount; ++i) {
        byCollision[i] = impulseOf(scratch.pairs[i]);
        isRegistered[i] = scratch.pairs[i].isTouched;
        if (registersAll) scratch.pairs[i].isTouched = true;
    }
    const ContactGraph graph = buildContactGraph(world, settings, dt, scratch);
    addForces(world, scratch.forces, dt);
    resolveContacts(world, graph, settings, dt, scratch);
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

/// Another order of the three, each turned at random.
void poseAtRandom(ShotRun& run, std::uint64_t drop)
{
    run.world = run.start;
    const BodyId bodies[] = {run.body("box"), run.body("ring"), run.body("ball")};
    const std::uint64_t first = randomIndex(3, 24, drop);
    for (std::uint64_t i = 0; i < 3; ++i) {
        const auto draw = [&](std::uint64_t what) {
            return 2.0 * randomUnit(24, drop, 10 * i + what) - 1.0;
        };
        BodyMotion& motion = run.world.motion[bodies[(first + i) % 3]];
        motion.position = {0.2 * draw(0), 0.8 + 1.1 * static_cast<double>(i), 0.2 * draw(1)};
        motion.orientation = exponentialMap(kPi * Vec3(draw(2), draw(3), draw(4)));
    }
}

/// All weight there is, stopped at once, asks for an impulse of one; what is well above has stopped
/// a fall.
constexpr double kBounce = 3.0;

struct Tally {
    int unregistered = 0, registered = 0;  ///< drops with an inelastic bounce
};

Tally countMissedBounces(const Context& context, bool registersAll, int iterations)
{
    ShotRun run(context, "E24_drops",
                {"solver.collision_iterations=" + std::to_string(iterations)});
    Tally tally;
    const Drops drops(context);
    for (std::uint64_t drop = drops.begin; drop < drops.end; ++drop) {
        poseAtRandom(run, drop);
        const double rate = std::array{24.0, 60.0, 240.0, 960.0}[drop % 4];
        bool missed = false, seen = false;
        for (int k = 0; k < 0.8 * rate; ++k) {
            const Blow blow = heaviestBlow(run.world, run.shot.settings, 1.0 / rate, registersAll);
            if (blow.excess < kBounce) continue;
            (blow.isRegistered ? seen : missed) = true;
        }
        tally.unregistered += missed;
        tally.registered += seen;
    }
    return tally;
}

/// Method scree keeps no set P, and its phases are not taken one by one. A blow that was not
/// elastic shows in what its step loses, since nothing else takes energy here; and one that
/// contacts stopped, in a step that knew no impact.
struct Losses {
    int plastic = 0;      ///< drops with a step that lost what a plastic blow takes
    int unseen = 0;       ///< drops with a blow in a step without impacts
    double most = 0.0;    ///< lost in a step, of what a plastic blow takes
    double gained = 0.0;  ///< likewise
};

/// The weakest blow between two bodies in a step, of those of `least` at least; that if there is
/// none [N s].
double weakestBlow(const StepSeen& step, double least)
{
    std::map<std::pair<BodyId, BodyId>, double> ofPairs;
    for (const ContactSeen& contact : step.contacts)
        ofPairs[{contact.a, contact.b}] += contact.impulse.dot(contact.normal);
    double weakest = 1e300;
    for (const auto& [bodies, impulse] : ofPairs) {
        if (impulse >= least) weakest = smaller(weakest, impulse);
    }
    return weakest < 1e300 ? weakest : least;
}

Losses lossesOf(const Context& context, const std::vector<std::string>& overrides)
{
    constexpr double kMass = 1.0;  // of each body of the shot [kg]
    ShotRun run(context, "E24_drops", overrides);
    const Vec3& gravity = run.shot.settings.gravity;
    Losses losses;
    const Drops drops(context);
    for (std::uint64_t drop = drops.begin; drop < drops.end; ++drop) {
        poseAtRandom(run, drop);
        const double rate = std::array{24.0, 60.0, 240.0, 960.0}[drop % 4];
        const double least = kBounce * 3.0 * kMass * gravity.norm() / rate;
        double before = mechanicalEnergy(run.world, gravity);
        bool isPlastic = false, isUnseen = false;
        Stepper stepper(run.shot.settings);
        LastStep last;
        stepper.observe(&last);
        for (int k = 0; k < 0.8 * rate; ++k) {
            const StepReport report = stepper.step(run.world, 1.0 / rate);
            const double now = mechanicalEnergy(run.world, gravity);
            const double lost = before - now + report.pushOutWork;
            before = now;
            // Stopped for good, a body of mass m loses J²/2m; bounced by e, (1 - e)/(1 + e) of it.
            const double blow = weakestBlow(last.seen, least);
            const double share = lost / (0.5 * blow * blow / kMass);
            isPlastic = isPlastic || !(share < 1.0);
            isUnseen = isUnseen || (blow > least && report.collisionImpulses.total() == 0);
            losses.most = larger(losses.most, share);
            losses.gained = larger(losses.gained, -share);
        }
        losses.plastic += isPlastic;
        losses.unseen += isUnseen;
    }
    return losses;
}

void noBlowIsLost(const Context& context, Findings& findings)
{
    const Drops drops(context);
    const std::string name = drops.name();
    const Losses losses = lossesOf(context, {});
    findings.equal(must, name + ": with a bounce that contacts stopped", losses.unseen, 0);
    findings.equal(must, name + ": with a plastic bounce", losses.plastic, 0);
    const std::string why = "in steps in which a body turns far, blows are not where they would be";
    findings.report(name + ": most lost in a step", losses.most, "of a plastic blow", why);
    findings.report(name + ": most gained in a step", losses.gained, "of a plastic blow", why);
    const double half = 0.5 * static_cast<double>(drops.end - drops.begin);
    findings.atLeast(
        control, name + ", restitution 0: with a plastic bounce",
        lossesOf(context, {"material.wood.restitution=0", "material.stone.restitution=0"}).plastic,
        half, "");
    findings.atLeast(control, name + ", no collisions: with a bounce that contacts stopped",
                     lossesOf(context, {"solver.collision_iterations=0"}).unseen, half, "");
}

}  // namespace

void runNoMissedBounce(const Context& context, Findings& findings)
{
    if (context.method == "scree") return noBlowIsLost(context, findings);
    const std::string name = Drops(context).name();
    for (int iterations : {5, 1}) {
        const std::string where =
            name + ", " + std::to_string(iterations) + " collision iterations: ";
        const Tally tally = countMissedBounces(context, false, iterations);
        findings.equal(must, where + "with a bounce that collision did not see", tally.unregistered,
                       0);
        findings.equal(departure, where + "with one it saw, not yet approaching", tally.registered,
                       0, "bodies that had met, and approached only once gravity had acted");
    }
    findings.atLeast(control, name + ", without P, one iteration: bounces not seen",
                     countMissedBounces(context, true, 1).unregistered, 1.0, "");
}

}  // namespace scree::verify
