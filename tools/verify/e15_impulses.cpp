// E15: impulses obey Newton, Coulomb and the conservation laws. [A29–A35]  Random pairs and mirror
// images of single impulses are built in code; the other collisions and the jam are shots, of
// either method.
#include <array>
#include <cmath>

#include "core/base/random.h"
#include "core/diagnostics/step_observer.h"
#include "core/dynamics/friction.h"
#include "core/dynamics/impulse.h"
#include "core/dynamics/integrator.h"
#include "core/math/rotation.h"
#include "tools/verify/experiments.h"
#include "tools/verify/pose_judge.h"
#include "tools/verify/shot_run.h"

namespace scree::verify {
namespace {

using enum Weight;

/// Draws named by what they are for, so that a case can be looked at alone.
class Draw {
public:
    explicit Draw(std::uint64_t sample) : sample_(sample) {}
    double between(double low, double high)
    {
        return low + (high - low) * randomUnit(15, sample_, next_++);
    }
    double logarithmic(double low, double high)
    {
        return std::exp(between(std::log(low), std::log(high)));
    }
    Vec3 vector(double size)
    {
        return {between(-size, size), between(-size, size), between(-size, size)};
    }
    Vec3 direction()
    {
        Vec3 v = vector(1.0);
        while (v.norm() < 0.1) v = vector(1.0);
        return v.normalized();
    }

private:
    std::uint64_t sample_, next_ = 0;
};

struct RandomBody {
    BodyMotion motion;
    BodyMass mass;
    PassInertia inertia;
    Vec3 r;

    Vec3 velocityAtContact() const { return pointVelocity(motion, inertia.inverseInertia, r); }
};

RandomBody randomBody(Draw& draw, double mass)
{
    RandomBody body;
    body.motion.orientation = exponentialMap(draw.vector(3.0));
    body.motion.velocity = draw.vector(2.0);
    body.r = draw.vector(1.0);
    if (mass > 0.0) {
        body.mass.inverseMass = 1.0 / mass;
        body.mass.inverseInertia = {draw.between(1.0, 9.0) / mass, draw.between(1.0, 9.0) / mass,
                                    draw.between(1.0, 9.0) / mass};
        body.motion.angularMomentum = mass * draw.vector(0.5);
    }
    body.inertia = passInertia(body.mass, body.motion.orientation);
    return body;
}

struct WorstOfPairs {
    double normal = 0.0, cone = 0.0, work = 0.0, momentum = 0.0, angular = 0.0;
    double leastPush = 1e300;
    std::int64_t fallbacks = 0;
};

void tryPair(std::uint64_t sample, WorstOfPairs& worst)
{
    Draw draw(sample);
    const double massA = draw.logarithmic(1e-3, 1e3);
    const double massB = draw.between(0.0, 1.0) < 0.2 ? 0.0 : draw.logarithmic(1e-3, 1e3);
    RandomBody a = randomBody(draw, massA), b = randomBody(draw, massB);
    const double e = draw.between(-1.0, 1.0), mu = draw.between(0.0, 5.0);
    const Vec3 u = a.velocityAtContact() - b.velocityAtContact();
    Vec3 n = draw.direction();
    if (u.dot(n) > 0.0) n = -n;
    const Mat3 k = collisionMatrix(a.inertia, a.r) + collisionMatrix(b.inertia, b.r);
    const ContactImpulse j = contactImpulse(k, u, n, e, mu);
    worst.fallbacks += j.kind == FrictionCase::fallback;

    const double energy = kineticEnergy(a.motion, a.mass) + kineticEnergy(b.motion, b.mass);
    const Vec3 pA = massA * a.motion.velocity, pB = massB * b.motion.velocity;
    // About the place of the contact.
    const auto spinOfBoth = [&] {
        return Vec3(a.motion.angularMomentum - a.r.cross(massA * a.motion.velocity) +
                    b.motion.angularMomentum - b.r.cross(massB * b.motion.velocity));
    };
    const Vec3 turning = spinOfBoth();
    applyImpulse(a.motion, a.inertia, a.r, j.impulse);
    applyImpulse(b.motion, b.inertia, b.r, -j.impulse);
    const Vec3 after = a.velocityAtContact() - b.velocityAtContact();

    const double push = j.impulse.dot(n);
    worst.leastPush = smaller(worst.leastPush, push);
    worst.normal = larger(worst.normal, std::abs(after.dot(n) + e * u.dot(n)) / u.norm());
    worst.cone = larger(worst.cone, (j.impulse - push * n).norm() / (mu * push + 1e-300));
    worst.work = larger(worst.work, workOf(j.impulse, k, u) / (energy + 1e-300));
    if (massB > 0.0) {
        const Vec3 sum = massA * a.motion.velocity + massB * b.motion.velocity - pA - pB;
        worst.momentum =
            larger(worst.momentum, sum.norm() / (pA.norm() + pB.norm() + j.impulse.norm()));
        worst.angular =
            larger(worst.angular, (spinOfBoth() - turning).norm() /
                                      (turning.norm() + j.impulse.norm() + pA.norm() + pB.norm()));
    }
}

void randomPairs(Findings& findings)
{
    WorstOfPairs worst;
    for (std::uint64_t sample = 0; sample < 100000; ++sample) tryPair(sample, worst);
    findings.atMost(must, "100 000 pairs: normal velocity off -e times what it was", worst.normal,
                    1e-9, "relative");
    findings.atMost(must, "100 000 pairs: tangential over friction times normal", worst.cone,
                    1.0 + 1e-12, "-");
    findings.atLeast(must, "100 000 pairs: least normal impulse", worst.leastPush, 0.0, "N s");
    findings.atMost(must, "100 000 pairs: work over kinetic energy", worst.work, 1e-12, "-");
    findings.atMost(must, "100 000 pairs: momentum changes", worst.momentum, 1e-13, "relative");
    findings.atMost(must, "100 000 pairs: angular momentum changes", worst.angular, 1e-13,
                    "relative");
    findings.atLeast(must, "100 000 pairs: uses of the fallback",
                     static_cast<double>(worst.fallbacks), 100.0, "");
}

void mirrorImages(Findings& findings)
{
    const Mat3 mirror = Vec3(-1.0, 1.0, 1.0).asDiagonal();
    double worst = 0.0;
    for (std::uint64_t sample = 0; sample < 1000; ++sample) {
        Draw draw(sample + 500000);
        const Mat3 root = Mat3::NullaryExpr([&] { return draw.between(-1.0, 1.0); });
        const Mat3 k = root * root.transpose() + 0.1 * Mat3::Identity();
        const Vec3 u = draw.vector(2.0);
        Vec3 n = draw.direction();
        if (u.dot(n) > 0.0) n = -n;
        const double e = draw.between(0.0, 1.0), mu = draw.between(0.0, 2.0);
        const Vec3 image =
            contactImpulse(mirror * k * mirror, mirror * u, mirror * n, e, mu).impulse;
        const Vec3 original = contactImpulse(k, u, n, e, mu).impulse;
        worst = larger(worst, (mirror * image - original).norm() / (1.0 + original.norm()));
    }
    findings.atMost(must, "mirror images: difference of the impulses", worst, 1e-12, "relative");
}

/// A ball that runs into another, `aside` of its centre, a quarter of a second later.
struct Strike : ShotRun {
    Strike(const Context& context, double aside, double restitution, double friction)
        : ShotRun(context, "E15_two_balls",
                  {setVector("body.still.position", {0.0, aside, 0.0}),
                   setNumber("material.ball.restitution", restitution),
                   setNumber("material.ball.friction", friction), "shape.ball.collide=\"exact\""})
    {
        advance(0.25, 240.0);
    }
};

void headOn(const Context& context, Findings& findings)
{
    const Strike elastic(context, 0.0, 1.0, 0.0), plastic(context, 0.0, 0.0, 0.0);
    const auto alongX = [](double speed) { return Vec3(speed, 0.0, 0.0); };
    findings.atMost(must, "head-on, e = 1: balls exchange their velocities, off by",
                    larger(elastic.motion("moving").velocity.norm(),
                           (elastic.motion("still").velocity - alongX(2.0)).norm()),
                    1e-12, "m/s");
    findings.atMost(must, "head-on, e = 0: both go on together, off by",
                    larger((plastic.motion("moving").velocity - alongX(1.0)).norm(),
                           (plastic.motion("still").velocity - alongX(1.0)).norm()),
                    1e-12, "m/s");
}

void offCentre(const Context& context, Findings& findings)
{
    const Strike run(context, 0.5, 0.5, 0.5), image(context, -0.5, 0.5, 0.5);
    const Momenta before = momentaOf(run.start), after = momentaOf(run.world);
    findings.atMost(must, "off centre: momentum changes", (after.linear - before.linear).norm(),
                    1e-12, "kg m/s");
    const double turned = (after.angular - before.angular).norm();
    if (context.method == "scree") {
        findings.atMost(must, "off centre: angular momentum changes", turned, 1e-12, "kg m^2/s");
    } else {
        findings.atMost(departure, "off centre: angular momentum changes", turned, 1e-12,
                        "kg m^2/s",
                        "lever arms are those of predicted positions (A22): first order in dt");
    }
    const double kept = kineticEnergy(run.world) / kineticEnergy(run.start);
    findings.atMost(must, "off centre: kinetic energy that is left", kept, 0.95, "of it");
    const Vec3 mirror(1.0, -1.0, 1.0);  // of velocities; spins the other way round
    double unlike = 0.0;
    for (const char* name : {"moving", "still"}) {
        const Vec3 v = image.motion(name).velocity.cwiseProduct(mirror);
        const Vec3 l = -image.motion(name).angularMomentum.cwiseProduct(mirror);
        unlike = larger(unlike, (v - run.motion(name).velocity).norm());
        unlike = larger(unlike, (l - run.motion(name).angularMomentum).norm());
    }
    findings.atMost(must, "off centre, mirrored: unlike the mirror image", unlike, 1e-12, "SI");
}

/// A rod that jams: it may neither be pulled nor gain, nor sink in.
void jam(const Context& context, Findings& findings)
{
    ShotRun run(context, "E15_jam");
    const PoseJudge judge(run.describe());
    LastStep last;
    run.stepper.observe(&last);
    double energy = mechanicalEnergy(run.world, run.shot.settings.gravity);
    double gain = 0.0, depth = 0.0, leastPush = 1e300;
    run.advance(0.5, 240.0, [&](const StepReport& report, double) {
        const double now = mechanicalEnergy(run.world, run.shot.settings.gravity);
        gain = larger(gain, now - energy - report.pushOutWork);
        energy = now;
        depth = larger(depth, judge.deepestOverlap(run.capture()));
        for (const ContactSeen& contact : last.seen.contacts)
            leastPush = smaller(leastPush, contact.impulse.dot(contact.normal));
    });
    findings.atLeast(must, "jammed rod: least push of the floor", leastPush, -1e-12, "N s");
    findings.atMost(must, "jammed rod: energy gained in a step", gain, 1e-9, "J",
                    "work of push-out apart");
    findings.atMost(must, "jammed rod: in the floor, any step", depth, 1e-3, "m",
                    "a thousandth of its length");
    addPicture(context, run, "The rod half a second after it jammed", findings);
}

/// Two balls of 1 kg run into a third between them; which is struck first is the order's choice.
void tripleCollision(const Context& context, Findings& findings)
{
    ShotRun run(context, "E15_three_balls");
    double left = 0.0, right = 0.0, momentum = 0.0, largest = 0.0;
    Curve ofLeft{"left", {}, {}}, ofRight{"right", {}, {}};
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        StepSettings settings = run.shot.settings;
        settings.seed = seed;
        World world = run.start;
        Stepper stepper(settings);
        for (int k = 0; k < 60; ++k) stepper.step(world, 1.0 / 240.0);
        const double l = world.motion[run.body("left")].velocity.norm();
        const double r = world.motion[run.body("right")].velocity.norm();
        left += l;
        right += r;
        for (const auto& [curve, speed] : {std::pair{&ofLeft, l}, {&ofRight, r}}) {
            curve->x.push_back(static_cast<double>(seed));
            curve->y.push_back(speed);
        }
        largest = larger(largest, std::abs(l - r));
        momentum = larger(momentum, momentaOf(world).linear.norm());
    }
    findings.atLeast(must, "triple collision, 100 seeds: mean speed of the outer balls",
                     0.005 * (left + right), 0.1, "m/s", "they come back");
    findings.atMost(must, "triple collision: mean of left less mean of right",
                    2.0 * std::abs(left - right) / (left + right), 0.02, "relative");
    findings.atMost(must, "triple collision: momentum", momentum, 1e-12, "kg m/s");
    findings.report("triple collision: largest difference with one seed", largest, "m/s");
    findings.plots.push_back({"Triple collision: speed of the outer balls afterwards",
                              "seed",
                              "speed [m/s]",
                              {ofLeft, ofRight}});
}

}  // namespace

void runImpulses(const Context& context, Findings& findings)
{
    randomPairs(findings);
    mirrorImages(findings);
    headOn(context, findings);
    offCentre(context, findings);
    tripleCollision(context, findings);
    jam(context, findings);
}

}  // namespace scree::verify
