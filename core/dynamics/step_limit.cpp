#include "core/dynamics/step_limit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/dynamics/body_pairs.h"
#include "core/dynamics/integrator.h"

namespace scree {
namespace {

/// Of method `scree`: what a body may fall in a step, as a share of the inner thickness. Dominoes
/// that may fall 4 % of theirs are awake for longer after they have fallen, and no faster for it.
/// So it is when the mean of thickness and size counts: 12 instead of 22 steps a frame, each of
/// which takes longer, for a pile of coins; a spiral of dominoes took 1.8 times as long.
constexpr double kFallPerStep = 0.02;

/// Of method `scree`: what ends in an edge is no thinner than this share of the largest ball
/// inside. A wall of a thousand shards took up to 222 steps a frame for the sake of their edges:
/// 6746 in all instead of 2297, with overlaps of at most 0.54 % of a shard instead of 0.64 %. With
/// twice the share, and 1460 steps, many rocked on and on. What is thin in more than a tenth of its
/// surface, as a pan with a stout handle, stays as thin as that.
constexpr double kOfInnerBall = 0.25;

/// Of method `scree`: how far the surfaces of bodies that may meet may pass each other in a step at
/// safety 1: a whole thickness, or what is thin so much of its bounding radius, but no more
/// thicknesses than that. Contacts are known before they touch, so that nothing is stepped over,
/// and only their features change on a long way. Of 192 plates of 8 mm thrown at others at up to
/// 25 m/s none gets through. A hundred and sixty forks and spoons took 112 steps a frame for a
/// thickness each, and take 53. With twice the share of their size bones take half the steps, in
/// the same time, and overlap by up to 0.9 % instead of 0.3 %. With no bound in thicknesses one of
/// sixty houses of cards blown down ended with two cards through each other, with it none.
constexpr double kPassedOfSize = 0.1, kPassedThicknesses = 4.0;

/// Of method `scree`: how far bodies that may meet may turn in a step at safety 1 [rad]. Gaps are
/// known to first order: what turns by φ beside another sinks into it by φ²/2 of its radius.
constexpr double kTurnPerStep = 0.16;

/// Of method `scree`: what would take more steps a frame than this, at safety 1, is a blur: pebbles
/// that turn three times around between two pictures. It may go farther in a step, but pass no more
/// thicknesses than what is thin may at any speed, and turn so many times as far. While 3500
/// pebbles pour onto each other at 5 m/s a frame took 3.9 instead of 7.2 s, in 76 instead of 222
/// steps, with overlaps of up to 1.2 instead of 0.6 % of a pebble. At 20 they are hardly faster,
/// since each step looks farther, and coins that pour overlap by 2.9 % instead of 2.4.
constexpr double kStepsSeen = 40.0, kBlurred = 8.0;

/// What a limit is for: that all touch as they should, or only that nothing goes through another.
enum class Limit { forSight, forBlur };

/// How a body may move in the rest of the frame, as far as its present motion or its script tell.
struct Outlook {
    Vec3 velocity = Vec3::Zero();
    std::vector<Vec3> scripted;  // of a keyed body instead: anything in their hull
    double spin = 0.0;           // that bends the way of its surface [rad/s]
    double surfaceSpeed = 0.0;   // by the spin [m/s]
    double speed = 0.0;          // of the fastest of its places [m/s]
    double pull = 0.0;           // [m/s²]
    // Of its shape [m].
    double thickness = 0.0;
    double passed = 0.0;  // per step, so that all touch as they should

    std::span<const Vec3> velocities() const
    {
        return scripted.empty() ? std::span(&velocity, 1) : std::span(scripted);
    }
};

/// What is round about an axis moves its surface only as that axis turns; but the way of that bends
/// as fast as all of the body spins.
Outlook outlookOf(const World& world, const StepSettings& settings, const AppliedForce& force,
                  BodyId body, double remaining)
{
    const Shape& shape = world.shapeOf(body);
    Outlook outlook;
    outlook.pull = force.acceleration.norm();
    outlook.thickness = thicknessForSteps(settings.method, shape);
    outlook.passed = passedPerStep(settings.method, shape);
    if (world.info[body].kind == BodyKind::keyed) {
        const ScriptBounds bounds =
            world.info[body].script->boundsBetween(world.time(), world.time(remaining));
        // The script moves the asset's origin, about which the centre of mass turns.
        const double arm = shape.bodyFromAsset.position.norm() + shape.boundingRadius;
        outlook.scripted = bounds.velocities;
        outlook.spin = bounds.spin;
        outlook.surfaceSpeed = bounds.spin * arm;
    } else if (world.isStepped(body)) {
        const double spin = angularVelocity(world.motion[body], world.mass[body]).norm();
        const double shown = shownSpin(world, settings, body);
        outlook.velocity = world.motion[body].velocity;
        outlook.spin = std::sqrt(shown * spin);
        outlook.surfaceSpeed = shown > 0.0 ? shown * shape.boundingRadius : 0.0;
    }
    for (const Vec3& velocity : outlook.velocities())
        outlook.speed = std::max(outlook.speed, velocity.norm() + outlook.surfaceSpeed);
    return outlook;
}

/// The largest relative speed of two surfaces; `along` a direction, if that is all that counts.
double relativeSpeed(const Outlook& a, const Outlook& b, const std::optional<Vec3>& along)
{
    double fastest = 0.0;
    for (const Vec3& v : a.velocities()) {
        for (const Vec3& w : b.velocities()) {
            const Vec3 relative = v - w;
            fastest = std::max(fastest, along ? std::abs(along->dot(relative)) : relative.norm());
        }
    }
    return fastest + a.surfaceSpeed + b.surfaceSpeed;
}

/// The dt with s dt + g dt² = length.
double timeToPass(double length, double s, double g)
{
    if (g <= 0.0) return s > 0.0 ? length / s : std::numeric_limits<double>::infinity();
    return 2.0 * length / (s + std::sqrt(s * s + 4.0 * g * length));
}

/// The box of a plane is all of space, but what is higher above it than it can come in the rest of
/// the frame does not meet it.
bool isHighAbove(const World& world, BodyId plane, BodyId body, double way)
{
    if (!world.shapeOf(plane).isPlane) return false;
    const BodyMotion& under = world.motion[plane];
    const Vec3 place =
        under.orientation.conjugate() * Vec3(world.motion[body].position - under.position);
    return place.y() - world.shapeOf(body).boundingRadius > way;
}

void tighten(StepLength& limit, double dt, StepLimit by, BodyId body)
{
    if (dt < limit.dt) limit = {dt, by, body, false};
}

/// What each is limited to by a pair.
struct PairLimits {
    double passed;  // way of the surfaces beside each other [m]
    double turned;  // [rad]
    double fallen;  // [m]
};

PairLimits limitsOf(const StepSettings& settings, const Outlook& a, const Outlook& b, Limit purpose)
{
    const bool isPaper = settings.method == Method::paper;
    const auto passed = [&](const Outlook& body) {
        return purpose == Limit::forBlur ? kPassedThicknesses * body.thickness : body.passed;
    };
    const double turned = purpose == Limit::forBlur ? kBlurred * kTurnPerStep : kTurnPerStep;
    return {settings.substeps.safety * std::min(passed(a), passed(b)),
            settings.substeps.safety * turned,
            (isPaper ? settings.hoverLimit : kFallPerStep) * std::min(a.thickness, b.thickness)};
}

/// Whether a pair cannot tighten the limit, whichever way its bodies move. Rods lie in the boxes of
/// fifty others each; without this a quarter of the time of a heap of straw went into its limits.
bool cannotTighten(const Outlook& a, const Outlook& b, const PairLimits& limits, double dt)
{
    constexpr double kRounding = 1.0 + 1e-9;
    const double longer = kRounding * dt;
    return longer * (a.speed + b.speed + longer * (a.pull + b.pull)) <= limits.passed &&
           longer * std::max(a.spin, b.spin) <= limits.turned &&
           longer * longer * std::max(a.pull, b.pull) <= limits.fallen;
}

void limitByPair(const World& world, const StepSettings& settings, const Prospect& prospect,
                 const std::vector<Outlook>& outlooks, BodyPair pair, double remaining,
                 Limit purpose, StepLength& limit)
{
    const auto [a, b] = pair;
    const Outlook &ofA = outlooks[a], &ofB = outlooks[b];
    const bool isPaper = settings.method == Method::paper;
    const bool isStepped = world.isStepped(a) || world.isStepped(b);
    const auto isMovedByScript = [&](BodyId body) {
        return world.info[body].kind == BodyKind::keyed && outlooks[body].speed > 0.0;
    };
    // A heap of cards that slept took five steps a frame, and two on a table that might move.
    if (!isPaper && !isStepped && !isMovedByScript(a) && !isMovedByScript(b)) return;
    const PairLimits limits = limitsOf(settings, ofA, ofB, purpose);
    if (cannotTighten(ofA, ofB, limits, limit.dt)) return;
    const BodyId faster =
        world.motion[a].velocity.norm() >= world.motion[b].velocity.norm() ? a : b;
    // What goes along a plane does not come nearer to it.
    const std::optional<Vec3> along = isPaper ? std::nullopt : normalOfPlane(world, pair);
    const double s = relativeSpeed(ofA, ofB, along);
    const double g = std::max(ofA.pull, ofB.pull);
    const double way = (s + g * remaining) * remaining;
    if (!isPaper && (isHighAbove(world, a, b, way) || isHighAbove(world, b, a, way))) return;
    const Vec3 pull = prospect.forces[a].acceleration - prospect.forces[b].acceleration;
    tighten(limit, timeToPass(limits.passed, s, pull.norm()), StepLimit::relativeSpeed, faster);
    const double spin = std::max(ofA.spin, ofB.spin);
    if (!isPaper && spin > 0.0)
        tighten(limit, limits.turned / spin, StepLimit::spin, ofA.spin > ofB.spin ? a : b);
    if (g > 0.0 && (isPaper || isStepped))
        tighten(limit, std::sqrt(limits.fallen / g), StepLimit::hover, faster);
}

/// No longer than `longest` [s].
StepLength limitByAll(const World& world, const StepSettings& settings, const Prospect& prospect,
                      const std::vector<Outlook>& outlooks, double remaining, double longest,
                      Limit purpose)
{
    StepLength limit{longest, StepLimit::frame, -1, false};
    // The first of equal limits counts, in the order of the pairs, however many threads there are.
    constexpr std::size_t kPairsTogether = 1024;
    const std::vector<BodyPair>& pairs = prospect.pairs;
    std::vector<StepLength> limits((pairs.size() + kPairsTogether - 1) / kPairsTogether, limit);
    parallelFor(limits.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin * kPairsTogether;
             i < std::min(end * kPairsTogether, pairs.size()); ++i) {
            limitByPair(world, settings, prospect, outlooks, pairs[i], remaining, purpose,
                        limits[i / kPairsTogether]);
        }
    });
    for (const StepLength& found : limits) {
        if (found.dt < limit.dt) limit = found;
    }
    const double turned = purpose == Limit::forBlur ? kBlurred * settings.maximumSpinPerStep
                                                    : settings.maximumSpinPerStep;
    for (std::size_t b = 0; b < world.bodyCount(); ++b) {
        if (outlooks[b].spin > 0.0)
            tighten(limit, turned / outlooks[b].spin, StepLimit::spin, static_cast<BodyId>(b));
    }
    return limit;
}

/// For method `scree`: a heap whose step length changes all the time never finds its rest, since
/// every change disturbs what its contacts remember. While anything may touch a frame has at least
/// four steps, which also resolve the bounce of a drop of a centimetre, and beyond that an even
/// number; within a frame steps only get shorter. With multiples of four a thousand rings took six
/// steps a frame instead of five and a half.
double steadyStep(const World& world, const StepSettings& settings, double frameDuration,
                  double longest, const Prospect& prospect)
{
    constexpr int kLeastSteps = 4, kStepsTogether = 2;
    const bool mayTouch = std::any_of(
        prospect.pairs.begin(), prospect.pairs.end(),
        [&](const BodyPair& pair) { return world.isStepped(pair.a) || world.isStepped(pair.b); });
    int steps = static_cast<int>(std::ceil(frameDuration / longest - 1e-9));
    if (mayTouch) {
        steps = (steps + kStepsTogether - 1) / kStepsTogether * kStepsTogether;
        steps = std::max(steps, kLeastSteps);
    }
    steps = std::clamp(steps, std::max(settings.substeps.min, 1), settings.substeps.max);
    const double dt = frameDuration / steps;
    return world.clock.subStep > 0 ? std::min(dt, world.contactMemory.dt) : dt;
}

}  // namespace

double thicknessForSteps(Method method, const Shape& shape)
{
    const double thickness = shape.thickness();
    if (method == Method::paper) return thickness;
    return std::max(thickness,
                    std::min(shape.commonThickness, kOfInnerBall * 2.0 * shape.innerBall.radius));
}

double passedPerStep(Method method, const Shape& shape)
{
    const double thickness = thicknessForSteps(method, shape);
    if (method == Method::paper) return 0.5 * thickness;
    // A thousand rings overlap by no more at a whole thickness than at half of it. At twice that
    // again five hundred bones take the same time, since every step looks twice as far.
    if (shape.isPlane) return thickness;
    return std::clamp(kPassedOfSize * shape.boundingRadius, thickness,
                      kPassedThicknesses * thickness);
}

double stepsToPass(const StepSettings& settings, const Shape& shape, double speed,
                   double frameDuration)
{
    const double way = frameDuration * speed / settings.substeps.safety;
    const double inSight = way / passedPerStep(settings.method, shape);
    const double seen = kStepsSeen / settings.substeps.safety;
    if (settings.method == Method::paper || inSight <= seen) return inSight;
    const double thickness = thicknessForSteps(settings.method, shape);
    return std::max(seen, way / (kPassedThicknesses * thickness));
}

double shownSpin(const World& world, const StepSettings& settings, BodyId body)
{
    const BodyMotion& motion = world.motion[body];
    const Vec3 spin = angularVelocity(motion, world.mass[body]);
    // Only a symplectic step turns what is round exactly, however far.
    const bool isExact =
        settings.method == Method::scree && settings.orientation == OrientationUpdate::symplectic;
    return (isExact ? world.shapeOf(body).shownOf(spin, motion.orientation) : spin).norm();
}

StepLength chooseStep(const World& world, const StepSettings& settings, double frameDuration,
                      double remaining, const Prospect& prospect)
{
    thread_local std::vector<Outlook> kept;
    std::vector<Outlook>& outlooks = kept;  // of this thread, filled by all
    outlooks.resize(world.bodyCount());
    forEach(world.bodyCount(), kShortWork, [&](std::size_t b) {
        outlooks[b] =
            outlookOf(world, settings, prospect.forces[b], static_cast<BodyId>(b), remaining);
    });
    // What is left of the frame is no wish of the motion: steps that had to fit into it would
    // halve, and halve again.
    const double longest = frameDuration / std::max(settings.substeps.min, 1);
    const auto limitFor = [&](Limit purpose) {
        return limitByAll(world, settings, prospect, outlooks, remaining, longest, purpose);
    };
    StepLength limit = limitFor(Limit::forSight);
    const double seen = settings.substeps.safety * frameDuration / kStepsSeen;
    if (settings.method == Method::scree && limit.dt < seen) {
        const StepLength blur = limitFor(Limit::forBlur);
        if (blur.dt < seen)
            limit = blur;
        else
            limit.dt = seen;
    }

    const double shortest = frameDuration / settings.substeps.max;
    if (limit.dt < shortest) {
        limit.dt = shortest;
        limit.limitedBy = StepLimit::substepCap;
        limit.capReached = true;
    }
    if (settings.method == Method::scree) {
        limit.dt = steadyStep(world, settings, frameDuration, limit.dt, prospect);
    }
    // Equal steps to the end of the frame; a hair of tolerance keeps rounding from adding one.
    const double steps = std::max(1.0, std::ceil(remaining / limit.dt - 1e-9));
    limit.dt = remaining / steps;
    return limit;
}

}  // namespace scree
