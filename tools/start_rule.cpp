#include "tools/start_rule.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <set>

#include "core/base/error.h"
#include "core/collision/interference.h"
#include "core/dynamics/body_pairs.h"
#include "core/dynamics/start_separation.h"
#include "io/build_world.h"
#include "tools/stop_signals.h"

namespace scree {
namespace {

constexpr std::size_t kNamed = 10;
// What is thrown about is rarely longer than a car and a trailer, heavier than a loaded lorry or
// smaller than a crumb, and no set is as long as a town; beyond, it is usually the unit. A plate
// whose file is in centimetres is 24 m long when it is read as metres.
constexpr double kLargestProp = 10.0, kSmallestProp = 2e-3, kLargestSet = 2000.0;  // [m]
constexpr double kHeaviestProp = 40'000.0;                                         // [kg]

struct LengthUnit {
    const char* name;
    double metres;
};
constexpr LengthUnit kUnits[] = {
    {"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}};

std::string formatted(const char* format, double a, double b = 0.0)
{
    char text[160];
    std::snprintf(text, sizeof text, format, a, b);
    return text;
}

std::string listOf(const std::vector<StartOverlap>& overlaps, const World& world)
{
    std::string text;
    for (std::size_t i = 0; i < std::min(overlaps.size(), kNamed); ++i) {
        text += "\n  " + describe(overlaps[i], world);
    }
    if (overlaps.size() > kNamed) {
        text += "\n  and " + std::to_string(overlaps.size() - kNamed) + " more";
    }
    return text;
}

std::string sentenceOf(const std::vector<StartOverlap>& overlaps, const World& world)
{
    return std::to_string(overlaps.size()) +
           (overlaps.size() == 1 ? " pair overlaps" : " pairs overlap") +
           " before anything moves:" + listOf(overlaps, world);
}

/// What to do about them. A mesh that looks inward has been turned, and may have been a room.
std::string adviceOn(const std::vector<StartOverlap>& overlaps, const World& world)
{
    std::string text = "\nMove them, or write [start] overlap = \"separate\" or \"warn\"";
    for (const StartOverlap& overlap : overlaps) {
        for (const BodyId body : {overlap.a, overlap.b}) {
            const Shape& shape = world.shapeOf(body);
            if (!shape.repairs.harmless.isTurned) continue;
            return text + "\nThe mesh of shape '" + shape.name +
                   "' was inside-out and has been turned, so that it is full; if it is a room seen "
                   "from inside, write mesh = { repair = \"room\" }";
        }
    }
    return text;
}

/// Thin things that cross take minutes to part: says now and then how many are left, and lets a
/// signal end it.
SeparationProgress progressOn(Console& console)
{
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kBetween{5};
    return [&console, last = Clock::now()](std::size_t pairsLeft) mutable {
        heedStop("nothing was simulated");
        if (Clock::now() - last < kBetween) return;
        last = Clock::now();
        console.info("pushing apart what overlaps: " + std::to_string(pairsLeft) +
                     (pairsLeft == 1 ? " pair left" : " pairs left"));
    };
}

std::string namesOf(const std::vector<BodyId>& bodies, const World& world)
{
    std::string text;
    for (std::size_t i = 0; i < std::min(bodies.size(), kNamed); ++i) {
        text += (i == 0 ? "" : ", ") + world.info[bodies[i]].name;
    }
    return text + (bodies.size() > kNamed ? ", …" : "");
}

/// Other units in which a length would be that of a prop: "; in cm it would be 0.24 m long".
std::string likelierUnits(double units, double metresPerUnit)
{
    std::string text;
    for (const LengthUnit& unit : kUnits) {
        const double size = units * unit.metres;
        if (size < 0.01 || size > 3.0 || unit.metres == metresPerUnit) continue;
        text += (text.empty() ? "; in " : ", in ") + std::string(unit.name) +
                (text.empty() ? " it would be" : "") + formatted(" %.3g m", size);
    }
    return text + (text.empty() ? "" : " long");
}

std::string describeHaste(const FastBody& body)
{
    if (!std::isfinite(body.stepsNeeded)) return "is faster than any number of steps can follow";
    return formatted("needs %.0f steps a frame at %.3g m/s", body.stepsNeeded, body.speed);
}

/// The static body that stands where a body is to be born, or −1. It never makes room.
BodyId obstacleTo(const World& world, BodyId newcomer)
{
    const Aabb box = boxAt(world.shapeOf(newcomer), world.motion[newcomer].worldFromBody());
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        if (world.info[body].kind != BodyKind::fixed) continue;
        if (!acceptEachOther(world, {newcomer, body})) continue;
        const Shape& shape = world.shapeOf(body);
        if (!box.overlaps(boxAt(shape, world.motion[body].worldFromBody()))) continue;
        const double tau = contourValue(world.shapeOf(newcomer), shape);
        if (deepestTouch(placePair(world, {newcomer, body}), tau)) return body;
    }
    return -1;
}

void warnOfBlockedBirths(const World& world, std::vector<std::string>& warnings)
{
    std::vector<BodyId> blocked;
    BodyId first = -1;
    for (const PlannedBirth& birth : world.births) {
        const BodyId obstacle = obstacleTo(world, birth.body);
        if (obstacle < 0) continue;
        if (blocked.empty()) first = obstacle;
        blocked.push_back(birth.body);
    }
    if (blocked.empty()) return;
    warnings.push_back(
        std::to_string(blocked.size()) + " of " + std::to_string(world.births.size()) +
        " emitted bodies can never come, for what is static stands at their places ('" +
        world.info[first].name + "' at the first): " + namesOf(blocked, world));
}

void warnOfRoughness(const World& world, std::vector<std::string>& warnings)
{
    constexpr double kItShows = 0.001;
    std::set<const Shape*> told;
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        const Shape& shape = world.shapeOf(body);
        if (shape.isPlane || !told.insert(&shape).second) continue;
        const std::string rough = roughnessOf(shape.assetMesh, kItShows);
        if (!rough.empty()) warnings.push_back("shape '" + shape.name + "' " + rough);
    }
}

void warnOfSizes(const Shot& shot, const World& world, std::vector<std::string>& warnings)
{
    std::set<const Shape*> told;
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        const Shape& shape = world.shapeOf(body);
        if (shape.isPlane || !told.insert(&shape).second) continue;
        const double size = shape.box.longestEdge();
        const BodyMass& weight = world.massWhenBorn(body);
        const double mass = weight.isMovable() ? 1.0 / weight.inverseMass : 0.0;
        const bool isProp = world.info[body].kind == BodyKind::dynamic;
        const bool isTooLong = size > (isProp ? kLargestProp : kLargestSet);
        const bool isTooHeavy = isProp && mass > kHeaviestProp;
        if (!isTooLong && !isTooHeavy && size >= kSmallestProp) continue;
        warnings.push_back(
            "'" + world.info[body].name + "' is " + formatted("%.3g m", size) + " long" +
            (isTooHeavy ? formatted(" and weighs %.3g t", mass / 1e3) : "") + ": are shot.units" +
            (isTooHeavy ? ", the density" : "") + " and the asset's scale right? One unit is " +
            formatted("%.3g m", shot.metresPerUnit) +
            likelierUnits(size / shot.metresPerUnit, shot.metresPerUnit));
    }
    const double g = shot.settings.gravity.norm();
    if (g > 50.0) {
        warnings.push_back(
            formatted("gravity is %.4g m/s², %.0f times the earth's: it is in m/s² "
                      "whatever shot.units says",
                      g, g / 9.81));
    }
}

/// A terrain whose faces are turned round is solid above: things would land on its floor.
void warnOfGroundsUpsideDown(const Shot& shot, const World& world,
                             std::vector<std::string>& warnings)
{
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        const Vec3 up =
            world.worldFromAsset(body).orientation * world.shapeOf(body).repairs.groundUp;
        if (up.dot(shot.settings.gravity) <= 0.0) continue;
        warnings.push_back("the faces of '" + world.info[body].name +
                           "' look down, so that what is above them is solid: turn them round in "
                           "the file of shape '" +
                           world.shapeOf(body).name + "'");
    }
}

/// What the shot asked to be done to a mesh; empty if nothing.
std::string describeAsked(const ShapeRepairs& done)
{
    switch (done.asked) {
        case MeshRepair::none:
            return "";
        case MeshRepair::wrap:
            return formatted("wrapped with voxels of %.3g m", done.voxel);
        case MeshRepair::shell:
            return formatted("made a shell with voxels of %.3g m", done.voxel);
        case MeshRepair::room:
            return formatted("put walls of %.3g m around it", done.behind);
        case MeshRepair::solidify:
            return formatted("given a back %.3g m behind it", done.behind);
        case MeshRepair::ground:
            break;
    }
    Eigen::Index axis;
    done.groundUp.cwiseAbs().maxCoeff(&axis);
    return formatted("closed %.3g m below its lowest point; its faces look along ", done.behind) +
           (done.groundUp[axis] > 0.0 ? '+' : '-') + "xyz"[axis];
}

}  // namespace

std::string describe(const StartOverlap& overlap, const World& world)
{
    return world.info[overlap.a].name + " and " + world.info[overlap.b].name +
           formatted(": %.3g m, %.2g %% of the smaller one's length", overlap.depth,
                     100.0 * overlap.ratio) +
           (overlap.isThroughWall ? ", through a wall" : "");
}

void applyStartRule(const Shot& shot, World& world, Console& console)
{
    const std::vector<StartOverlap> overlaps = findStartOverlaps(world, shot.penetrationWarn);
    if (overlaps.empty()) return;
    const std::string what = sentenceOf(overlaps, world);
    switch (shot.startOverlap) {
        case StartOverlapRule::error:
            throw Error(ErrorKind::badInput, what + adviceOn(overlaps, world));
        case StartOverlapRule::warn:
            console.warning(what);
            return;
        case StartOverlapRule::separate:
            if (!separateAtStart(world, shot.settings, shot.penetrationWarn, progressOn(console))) {
                throw Error(
                    ErrorKind::badInput,
                    what + "\nThey could not be pushed apart; still overlapping are:" +
                        listOf(findStartOverlaps(world, 0.5 * shot.penetrationWarn), world));
            }
            console.info(what + "\nThey were pushed apart");
            return;
    }
}

bool foretellStartRule(const Shot& shot, const World& world,
                       const std::vector<StartOverlap>& overlaps, Console& console)
{
    if (overlaps.empty()) return true;
    const std::string what = sentenceOf(overlaps, world);
    switch (shot.startOverlap) {
        case StartOverlapRule::error:
            console.error(what + adviceOn(overlaps, world));
            return false;
        case StartOverlapRule::warn:
            console.warning(what);
            return true;
        case StartOverlapRule::separate:
            console.info(what + "\nsim pushes them apart, or refuses the shot if it cannot");
            return true;
    }
    return true;
}

std::vector<std::string> warningsBeforeStart(const Shot& shot, const World& world)
{
    std::vector<std::string> warnings = shot.warnings;
    const std::vector<BodyId> loose = findUnsupported(world, shot.settings.gravity);
    if (!loose.empty()) {
        warnings.push_back(std::to_string(loose.size()) +
                           (loose.size() == 1 ? " body has nothing static under it"
                                              : " bodies have nothing static under them") +
                           " and may fall for ever: " + namesOf(loose, world));
    }
    const std::vector<FastBody> fast =
        findTooFast(world, shot.settings, 1.0 / shot.framesPerSecond);
    if (!fast.empty()) {
        warnings.push_back(
            std::to_string(fast.size()) + (fast.size() == 1 ? " body is" : " bodies are") +
            " too fast for solver.substeps.max = " + std::to_string(shot.settings.substeps.max) +
            "; '" + world.info[fast.front().body].name + "' " + describeHaste(fast.front()) +
            (fast.front().whenItLands ? ", when it lands" : ", at the start"));
    }
    warnOfBlockedBirths(world, warnings);
    warnOfSizes(shot, world, warnings);
    warnOfGroundsUpsideDown(shot, world, warnings);
    warnOfRoughness(world, warnings);
    return warnings;
}

std::string describe(const MeshDeviation& drawnToColliding)
{
    const Vec3& place = drawnToColliding.place;
    char text[200];
    std::snprintf(text, sizeof text,
                  "what collides is up to %.3g m from what is drawn, at (%.4g, %.4g, %.4g) of %s",
                  drawnToColliding.distance, place.x(), place.y(), place.z(),
                  drawnToColliding.isOnFirst ? "what is drawn" : "what collides");
    return text;
}

std::vector<std::string> repairsOf(const World& world)
{
    std::vector<std::string> repairs;
    std::set<const Shape*> told;
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        const Shape& shape = world.shapeOf(body);
        if (!told.insert(&shape).second) continue;
        const ShapeRepairs& done = shape.repairs;
        if (!done.harmless.isNone()) {
            repairs.push_back("shape '" + shape.name + "': " + describe(done.harmless));
        }
        if (done.asked == MeshRepair::none && !done.hasCollisionMesh) continue;
        std::string text = "shape '" + shape.name + "': ";
        if (done.hasCollisionMesh) text += "collides as a mesh of its own";
        if (done.hasCollisionMesh && done.asked != MeshRepair::none) text += ", ";
        text += describeAsked(done);
        // What was put behind what is drawn is nowhere near it, nor need it be.
        const bool isExact = done.behind > 0.0;
        const bool isComparable = !isExact || done.hasCollisionMesh;
        repairs.push_back(isComparable ? text + "; " + describe(done.drawnToColliding) : text);
    }
    return repairs;
}

}  // namespace scree
