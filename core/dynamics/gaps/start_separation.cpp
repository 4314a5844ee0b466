#include "core/dynamics/gaps/start_separation.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/dynamics/contact_graph.h"
#include "core/dynamics/gaps/gap_blocks.h"
#include "core/dynamics/gaps/gap_layout.h"
#include "core/dynamics/gaps/gap_levels.h"
#include "core/dynamics/gaps/gap_push_out.h"
#include "core/dynamics/gaps/gap_rows.h"
#include "core/dynamics/gaps/sleep.h"
#include "core/dynamics/integrator.h"
#include "core/dynamics/push_out.h"
#include "core/dynamics/scratch.h"
#include "core/dynamics/start_overlap.h"

namespace scree {
namespace {

/// Pushing apart goes on while it helps: until the total of all depths has not sunk by this share
/// of itself in so many rounds. Of 500 straws in a heap 942 pairs crossed, and after a hundred
/// rounds seven were left.
constexpr int kRoundsWithoutGain = 80;
constexpr double kGain = 0.01;

constexpr double kSeparationStep = 1.0 / 240.0;  // whose fall tells who rests on whom [s]

/// Contacts part what has only sunk into each other, and know who rests on whom. Nails that cross
/// each other they hold as they are: after so many rounds of theirs, and again and again, who is as
/// deep in another as a round before is moved by the shortest way out.
constexpr int kRoundsOfContacts = 10, kRoundsBetween = 2;
constexpr double kAsDeep = 0.9;

/// What has gained nothing for so many rounds is hemmed in: out of one it comes into the next. With
/// half as many, cubes that had been packed a tenth too closely jumped past their neighbours.
constexpr int kRoundsHemmedIn = 40;

/// How far a body is tried from where it is, in growing steps: from so much of what is thin on, and
/// of the way on which all is tried.
constexpr double kFirstTry = 0.3, kLeastTry = 1e-3, kNextTry = 1.2;

/// One sweep of push-out over everything that overlaps, as the methods do it.
void separateGapsOnce(World& world, const StepSettings& settings)
{
    GapScratch scratch;
    layOutGaps(world, settings, kSeparationStep, SolvedIslands(), scratch);
    forBlocks(scratch, [&](const GapBlock& block) {
        buildRows(world, settings, kSeparationStep, block, scratch);
        findLevels(kSeparationStep, block, scratch);
    });
    separateGaps(world, settings, scratch);
}

void separateOnce(World& world, const StepSettings& settings)
{
    if (settings.method == Method::scree) return separateGapsOnce(world, settings);
    StepScratch scratch;
    findPairs(world, settings, 0.0, scratch);
    beginStep(world, settings, kSeparationStep, scratch);
    for (std::size_t i = 0; i < scratch.pairCount; ++i) {
        PairRecord& pair = scratch.pairs[i];
        pair.isTouched = deepestTouch(placePair(world, pair.bodies), 0.0).has_value();
    }
    const ContactGraph graph = buildContactGraph(world, settings, kSeparationStep, scratch);
    separateOverlaps(world, graph, settings, scratch);
}

/// Along the edges, and across the faces and the corners, of a cube.
std::vector<Vec3> directionsOfCube()
{
    std::vector<Vec3> directions;
    for (const double x : {-1.0, 0.0, 1.0}) {
        for (const double y : {-1.0, 0.0, 1.0}) {
            for (const double z : {-1.0, 0.0, 1.0}) {
                const Vec3 direction(x, y, z);
                if (!direction.isZero(0.0)) directions.push_back(direction.normalized());
            }
        }
    }
    return directions;
}

/// The shortest way of the first of two bodies, about, by no more than the size of the smaller,
/// after which it `isOut`; nothing if there is none [m]. It need not be where either has its
/// contacts: two rods that cross come apart square to both.
template <class IsOut>
std::optional<Vec3> shortestWay(const PlacedPair& placed, const IsOut& isOut)
{
    static const std::vector<Vec3> ofCube = directionsOfCube();
    const Shape &a = *placed.shapeA, &b = *placed.shapeB;
    std::vector<Vec3> directions;
    for (const Pose& frame : {placed.worldFromA, placed.worldFromB}) {
        for (const Vec3& direction : ofCube) directions.push_back(frame.orientation * direction);
    }
    const double most = 2.0 * std::min(a.boundingRadius, b.boundingRadius);
    const double thin = std::min(a.commonThickness, b.commonThickness);
    for (double way = std::max(kFirstTry * thin, kLeastTry * most); way < most; way *= kNextTry) {
        for (const Vec3& direction : directions) {
            Pose moved = placed.worldFromA;
            moved.position += way * direction;
            if (isOut(moved)) return way * direction;
        }
    }
    return std::nullopt;
}

std::optional<Vec3> wayOutOfTheOther(const World& world, const OverlapMeasure& measure,
                                     BodyPair bodies)
{
    const PlacedPair placed = placePair(world, bodies);
    return shortestWay(placed, [&](const Pose& worldFromA) {
        PlacedPair moved = placed;
        moved.worldFromA = worldFromA;
        return !measure(bodies, moved, 0.0);
    });
}

/// For the first of two bodies, past everybody.
std::optional<Vec3> wayOutOfAll(const World& world, const OverlapMeasure& measure,
                                const std::vector<Aabb>& boxes, BodyPair bodies)
{
    return shortestWay(placePair(world, bodies), [&](const Pose& worldFromA) {
        const Aabb box = boxAt(world.shapeOf(bodies.a), worldFromA);
        for (BodyId other = 0; other < static_cast<BodyId>(boxes.size()); ++other) {
            const BodyPair pair{bodies.a, other};
            if (other == bodies.a || !box.overlaps(boxes[other]) || !mayCollide(world, pair))
                continue;
            PlacedPair moved = placePair(world, pair);
            moved.worldFromA = worldFromA;
            if (measure(pair, moved, 0.0)) return false;
        }
        return true;
    });
}

/// Those of the overlaps that are no less deep than they were.
std::vector<StartOverlap> heldOf(const std::vector<StartOverlap>& overlaps,
                                 const std::vector<StartOverlap>& before)
{
    std::vector<StartOverlap> held;
    std::ranges::copy_if(overlaps, std::back_inserter(held), [&](const StartOverlap& now) {
        return std::ranges::any_of(before, [&](const StartOverlap& then) {
            return then.a == now.a && then.b == now.b && now.depth >= kAsDeep * then.depth;
        });
    });
    return held;
}

double totalDepth(const std::vector<StartOverlap>& overlaps)
{
    double total = 0.0;
    for (const StartOverlap& overlap : overlaps) total += overlap.depth;
    return total;
}

/// The ways of the first of each two.
template <class WayOf>
std::vector<std::optional<Vec3>> waysOf(const std::vector<StartOverlap>& overlaps,
                                        const WayOf& wayOf)
{
    std::vector<std::optional<Vec3>> ways(overlaps.size());
    parallelFor(overlaps.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) ways[i] = wayOf(overlaps[i]);
    });
    return ways;
}

/// Moves overlapping bodies out of each other, the heavier one less.
void moveOutOfEachOther(World& world, const std::vector<StartOverlap>& overlaps)
{
    const OverlapMeasure measure(world);
    const auto ways = waysOf(overlaps, [&](const StartOverlap& overlap) {
        return wayOutOfTheOther(world, measure, {overlap.a, overlap.b});
    });
    for (std::size_t i = 0; i < overlaps.size(); ++i) {
        if (!ways[i]) continue;
        const BodyId a = overlaps[i].a, b = overlaps[i].b;
        const double ofA = isUnmovedBy(world, a, b) ? 0.0 : world.mass[a].inverseMass;
        const double ofB = isUnmovedBy(world, b, a) ? 0.0 : world.mass[b].inverseMass;
        if (ofA + ofB == 0.0) continue;
        world.motion[a].position += ofA / (ofA + ofB) * *ways[i];
        world.motion[b].position -= ofB / (ofA + ofB) * *ways[i];
    }
}

/// Moves one of each two to where it meets nobody.
void moveOutOfAll(World& world, const std::vector<StartOverlap>& overlaps)
{
    const OverlapMeasure measure(world);
    const std::vector<Aabb> boxes = startBoxes(world);
    const auto moverFirst = [&](const StartOverlap& overlap) {
        const bool isFirst =
            world.mass[overlap.a].isMovable() && !isUnmovedBy(world, overlap.a, overlap.b);
        return isFirst ? BodyPair{overlap.a, overlap.b} : BodyPair{overlap.b, overlap.a};
    };
    const auto ways = waysOf(overlaps, [&](const StartOverlap& overlap) {
        return wayOutOfAll(world, measure, boxes, moverFirst(overlap));
    });
    for (std::size_t i = 0; i < overlaps.size(); ++i) {
        if (ways[i]) world.motion[moverFirst(overlaps[i]).a].position += *ways[i];
    }
}

}  // namespace

bool separateAtStart(World& world, const StepSettings& settings, double leastRatio,
                     const SeparationProgress& tell)
{
    // Velocities would tell the graph of falls that have nothing to do with who lies on whom.
    const std::vector<BodyMotion> asPlaced = world.motion;
    for (BodyMotion& motion : world.motion) {
        motion.velocity.setZero();
        motion.angularMomentum.setZero();
    }
    // Who sleeps would not be moved.
    std::vector<BodyId> sleepers;
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        if (world.contactMemory.isAsleep(body)) sleepers.push_back(body);
    }
    world.contactMemory = {};
    std::vector<StartOverlap> overlaps = findStartOverlaps(world, 0.5 * leastRatio), before;
    double least = totalDepth(overlaps);
    int sinceGain = 0;
    for (int round = 0; sinceGain < kRoundsWithoutGain && !overlaps.empty(); ++round) {
        if (tell) tell(overlaps.size());
        if (sinceGain >= kRoundsHemmedIn)
            moveOutOfAll(world, overlaps);
        else if (round >= kRoundsOfContacts && round % kRoundsBetween == 0)
            moveOutOfEachOther(world, heldOf(overlaps, before));
        separateOnce(world, settings);
        before = std::exchange(overlaps, findStartOverlaps(world, 0.5 * leastRatio));
        const double total = totalDepth(overlaps);
        ++sinceGain;
        if (total > (1.0 - kGain) * least) continue;
        least = total;
        sinceGain = 0;
    }
    for (std::size_t i = 0; i < asPlaced.size(); ++i) {
        const BodyMotion& placed = asPlaced[i];
        BodyMotion& now = world.motion[i];
        now.velocity = placed.velocity;
        now.angularMomentum = placed.angularMomentum;
        if (now.orientation.coeffs() == placed.orientation.coeffs()) continue;
        // Turned, it spins as the shot says only with another angular momentum.
        now.angularMomentum =
            momentumOfSpin(now, world.mass[i], angularVelocity(placed, world.mass[i]));
    }
    sleepFromTheStart(world, settings, sleepers);
    return overlaps.empty();
}

}  // namespace scree
