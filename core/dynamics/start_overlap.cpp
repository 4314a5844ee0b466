#include "core/dynamics/start_overlap.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "core/base/parallel.h"
#include "core/collision/broad_phase.h"
#include "core/collision/near_features.h"

namespace scree {
namespace {

/// What is in another by so much of what is thin in either goes through a wall of it. Half would be
/// as deep as it can be, and samples do not see all of that. Bottles that had been strewn with the
/// neck of one in the side of another, by 0.6 % of their length, rolled about like that for as long
/// as anybody looked.
constexpr double kThroughWall = 0.3;

/// How deep their surfaces are in each other, if that is deeper than `least`; 0 otherwise [m].
double depthOf(const PlacedPair& pair, double least)
{
    const std::optional<Touch> deepest = deepestTouch(pair, -least);
    return deepest ? -deepest->phi : 0.0;
}

/// How deep is through a wall of one of the two [m]; what a plane bounds has none.
double throughWall(const World& world, BodyPair bodies)
{
    const Shape &a = world.shapeOf(bodies.a), &b = world.shapeOf(bodies.b);
    if (a.isPlane || b.isPlane) return std::numeric_limits<double>::infinity();
    return kThroughWall * std::min(a.commonThickness, b.commonThickness);
}

}  // namespace

OverlapMeasure::Inside::Inside(const Shape& shape)
    : points(pointsInside(shape.mesh, shape.innerThickness))
{
    std::vector<Ball> spheres;
    for (const auto& point : points.colwise()) spheres.push_back({point, 0.0});
    tree = SphereTree(spheres);
}

OverlapMeasure::OverlapMeasure(const World& world) : world_(world)
{
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        const auto [known, isNew] = inside_.try_emplace(&world.shapeOf(body));
        if (isNew) known->second = Inside(*known->first);
    }
}

/// A ball about a point inside of the one that fits into both is a lower bound. Not less than
/// `deepest`, how deep they are known to be.
double OverlapMeasure::insideOfFirst(const Shape& first, const Shape& second,
                                     const Pose& secondFromFirst, double deepest) const
{
    const Inside& inside = inside_.at(&first);
    inside.tree.visit(
        [&](const Vec3& centre, double radius) {
            return second.distance.isClearOf(secondFromFirst * centre, radius - deepest);
        },
        [&](std::uint32_t i) {
            const Vec3 point = inside.points.col(i);
            const double depth = -second.distance.value(secondFromFirst * point);
            if (depth <= deepest) return;
            deepest = std::max(deepest, std::min(depth, -first.distance.value(point)));
        });
    return deepest;
}

double OverlapMeasure::insideBoth(const PlacedPair& placed, double known) const
{
    const Shape &a = *placed.shapeA, &b = *placed.shapeB;
    const double ofA = insideOfFirst(a, b, inverse(placed.worldFromB) * placed.worldFromA, known);
    return insideOfFirst(b, a, inverse(placed.worldFromA) * placed.worldFromB, ofA);
}

std::optional<StartOverlap> OverlapMeasure::operator()(BodyPair bodies, const PlacedPair& placed,
                                                       double leastRatio) const
{
    const double through = throughWall(world_, bodies);
    const double least = std::min(leastRatio * smallerEdge(world_, bodies.a, bodies.b), through);
    if (apartAtLeast(placed) > -least) return std::nullopt;
    const double depth = insideBoth(placed, std::max(depthOf(placed, least), least));
    if (depth <= least) return std::nullopt;
    return StartOverlap{bodies.a, bodies.b, depth, overlapRatio(world_, bodies, depth),
                        depth > through};
}

std::vector<Aabb> startBoxes(const World& world)
{
    std::vector<Aabb> boxes(world.bodyCount());
    for (BodyId body = 0; body < static_cast<BodyId>(boxes.size()); ++body) {
        if (world.isBorn(body)) boxes[body] = boxOf(world, body);
    }
    return boxes;
}

std::vector<StartOverlap> findStartOverlaps(const World& world, double leastRatio)
{
    BroadPhase broadPhase;
    const std::vector<BodyPair>& pairs = broadPhase.findPairs(
        startBoxes(world), world.mass, [&](BodyPair pair) { return mayCollide(world, pair); });
    const OverlapMeasure measure(world);
    std::vector<StartOverlap> found(pairs.size());
    parallelFor(pairs.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            found[i] =
                measure(pairs[i], placePair(world, pairs[i]), leastRatio).value_or(StartOverlap{});
    });
    std::vector<StartOverlap> overlaps;
    std::copy_if(found.begin(), found.end(), std::back_inserter(overlaps),
                 [](const StartOverlap& overlap) { return overlap.depth > 0.0; });
    std::stable_sort(overlaps.begin(), overlaps.end(),
                     [](const auto& p, const auto& q) { return p.ratio > q.ratio; });
    return overlaps;
}

}  // namespace scree
