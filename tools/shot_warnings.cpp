#include "tools/shot_warnings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/dynamics/births.h"
#include "core/dynamics/body_pairs.h"
#include "core/dynamics/start_check.h"
#include "io/build_world.h"
#include "io/text_forms.h"

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

/// A static body, which never makes room.
struct Obstacle {
    BodyId body;
    Aabb box;
};

std::vector<Obstacle> obstaclesIn(const World& world)
{
    std::vector<Obstacle> obstacles;
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        if (world.info[body].kind == BodyKind::fixed)
            obstacles.push_back({body, boxOf(world, body)});
    }
    return obstacles;
}

/// The one that stands where a body is to be born, or −1.
BodyId obstacleTo(const World& world, const std::vector<Obstacle>& obstacles, BodyId newcomer)
{
    const Aabb box = boxOf(world, newcomer);
    for (const Obstacle& obstacle : obstacles) {
        if (box.overlaps(obstacle.box) && standsInTheWay(world, obstacle.body, newcomer))
            return obstacle.body;
    }
    return -1;
}

void warnOfBlockedBirths(const World& world, std::vector<std::string>& warnings)
{
    const std::vector<Obstacle> obstacles = obstaclesIn(world);
    std::vector<BodyId> blocked;
    BodyId first = -1;
    for (const PlannedBirth& birth : world.births) {
        const BodyId obstacle = obstacleTo(world, obstacles, birth.body);
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

/// Of the movable [kg]; 0 of the others.
double massOf(const World& world, BodyId body)
{
    const BodyMass& weight = world.massWhenBorn(body);
    return weight.isMovable() ? 1.0 / weight.inverseMass : 0.0;
}

/// One body speaks for all that are odd in the same way: the shards of a boulder are many.
void warnOfSizes(const Shot& shot, const World& world, std::vector<std::string>& warnings)
{
    std::set<const Shape*> seen;
    std::map<std::string, std::vector<BodyId>> odd;  // by what they are
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        const Shape& shape = world.shapeOf(body);
        if (shape.isPlane || !seen.insert(&shape).second) continue;
        const double size = shape.box.longestEdge();
        const bool isProp = world.info[body].kind == BodyKind::dynamic;
        if (isProp && massOf(world, body) > kHeaviestProp)
            odd["heavy"].push_back(body);
        else if (size > (isProp ? kLargestProp : kLargestSet))
            odd["large"].push_back(body);
        else if (size < kSmallestProp)
            odd["small"].push_back(body);
    }
    for (auto& [what, bodies] : odd) {
        const BodyId body = bodies.front();
        const double size = world.shapeOf(body).box.longestEdge();
        const bool isTooHeavy = what == "heavy";
        std::string warning =
            "'" + world.info[body].name + "' is " + formatted("%.3g m", size) + " long" +
            (isTooHeavy ? formatted(" and weighs %.3g t", massOf(world, body) / 1e3) : "") +
            ": are shot.units" + (isTooHeavy ? ", the density" : "") +
            " and the asset's scale right? One unit is " + formatted("%.3g m", shot.metresPerUnit) +
            likelierUnits(size / shot.metresPerUnit, shot.metresPerUnit);
        bodies.erase(bodies.begin());
        if (!bodies.empty())
            warning += "; " + std::to_string(bodies.size()) + " more are as " + what + ": " +
                       namesOf(bodies, world);
        warnings.push_back(warning);
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

bool isSame(const Pose& a, const Pose& b)
{
    return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs();
}

/// Whether keys move a body up to about the moment it is let go, and yet it is at rest then. Who
/// holds a pose for longer wants it held.
bool isThrowWithoutSpeed(const Shot& shot, const ShotBody& body)
{
    constexpr double kRounding = 1e-6;  // of a frame
    if (!body.releaseFrame || body.keys.size() < 2) return false;
    const MotionKey &last = body.keys.back(), &before = body.keys[body.keys.size() - 2];
    if (isSame(last.pose, before.pose)) return false;
    const double held =
        *body.releaseFrame - shot.firstFrame - last.time * shot.framesPerSecond;  // [frames]
    const bool endsAtRest = body.interpolation == KeyInterpolation::smooth;
    return held > (endsAtRest ? -kRounding : kRounding) && held < 1.0 + kRounding;
}

}  // namespace

std::vector<std::string> notesBeforeStart(const Shot& shot)
{
    // All bodies of an import stand at one place of the shot's file.
    std::map<std::string, std::vector<const ShotBody*>> thrown;
    for (const ShotBody& body : shot.bodies)
        if (isThrowWithoutSpeed(shot, body)) thrown[toString(body.location)].push_back(&body);
    std::vector<std::string> notes;
    for (const auto& [place, bodies] : thrown) {
        const ShotBody& body = *bodies.front();
        const bool endsAtRest = body.interpolation == KeyInterpolation::smooth;
        const std::string others =
            bodies.size() > 1 ? " (and " + std::to_string(bodies.size() - 1) + " more)" : "";
        notes.push_back(
            place + ": '" + body.name + "'" + others + " is let go at frame " +
            std::to_string(*body.releaseFrame) +
            " at rest: " + (endsAtRest ? "smooth motion ends at rest" : "its motion ends") +
            " at its last key, at frame " +
            formatted("%g", shot.firstFrame + body.keys.back().time * shot.framesPerSecond) +
            "; to throw it, " +
            (endsAtRest ? "give it a key after its release, or interpolate = \"linear\""
                        : "let it go at that key, or give it one after its release"));
    }
    return notes;
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

}  // namespace scree
