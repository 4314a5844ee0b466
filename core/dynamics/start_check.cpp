// Symbols: g gravity, down its direction, drop the way to what lies under a body.
#include "core/dynamics/start_check.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <unsupported/Eigen/BVH>

#include "core/base/parallel.h"
#include "core/collision/near_features.h"
#include "core/dynamics/contact_graph.h"
#include "core/dynamics/gap_blocks.h"
#include "core/dynamics/gap_layout.h"
#include "core/dynamics/gap_levels.h"
#include "core/dynamics/gap_push_out.h"
#include "core/dynamics/gap_rows.h"
#include "core/dynamics/push_out.h"
#include "core/dynamics/scratch.h"
#include "core/dynamics/sleep.h"
#include "core/dynamics/step_limit.h"

namespace scree {
namespace {

/// What is in another by so much of what is thin in either goes through a wall of it. Half would be
/// as deep as it can be, and samples do not see all of that. Bottles that had been strewn with the
/// neck of one in the side of another, by 0.6 % of their length, rolled about like that for as long
/// as anybody looked.
constexpr double kThroughWall = 0.3;

constexpr int kMostRounds = 100;                 // of pushing apart
constexpr double kSeparationStep = 1.0 / 240.0;  // whose fall tells who rests on whom [s]

std::vector<Aabb> boxesOf(const World& world)
{
    std::vector<Aabb> boxes(world.bodyCount());  // an empty box meets nothing
    for (BodyId body = 0; body < static_cast<BodyId>(boxes.size()); ++body) {
        if (!world.isBorn(body)) continue;
        boxes[body] = boxAt(world.shapeOf(body), world.motion[body].worldFromBody());
    }
    return boxes;
}

/// How deep their surfaces are in each other, if that is deeper than `least`; 0 otherwise [m].
double depthOf(const PlacedPair& pair, double least)
{
    const std::optional<Touch> deepest = deepestTouch(pair, -least);
    return deepest ? -deepest->phi : 0.0;
}

/// How deep bodies are in each other whose surfaces tell nothing: where a body stands in the place
/// of its copy, or flush with it, every corner lies on the other's surface. Asks the points inside
/// of both; a ball about such a point that fits into both is a lower bound.
class InnerDepth {
public:
    explicit InnerDepth(const World& world) : world_(world)
    {
        for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
            const auto [known, isNew] = inside_.try_emplace(&world.shapeOf(body));
            if (isNew) known->second = Inside(*known->first);
        }
    }

    /// Not less than `known`, how deep their surfaces are in each other.
    double operator()(BodyId a, BodyId b, double known) const
    {
        return ofFirst(b, a, ofFirst(a, b, known));
    }

private:
    struct Inside {
        Points points;
        SphereTree tree;

        Inside() = default;
        explicit Inside(const Shape& shape) : points(pointsInside(shape.mesh, shape.innerThickness))
        {
            std::vector<Sphere> spheres;
            for (const auto& point : points.colwise()) spheres.push_back({point, 0.0});
            tree = SphereTree(spheres);
        }
    };

    double ofFirst(BodyId first, BodyId second, double deepest) const
    {
        const Shape& shape = world_.shapeOf(first);
        const Shape& other = world_.shapeOf(second);
        const Inside& inside = inside_.at(&shape);
        const Pose otherFromFirst =
            inverse(world_.motion[second].worldFromBody()) * world_.motion[first].worldFromBody();
        inside.tree.visit(
            [&](const Vec3& centre, double radius) {
                return other.distance.isClearOf(otherFromFirst * centre, radius - deepest);
            },
            [&](std::uint32_t i) {
                const Vec3 point = inside.points.col(i);
                const double depth = -other.distance.value(otherFromFirst * point);
                if (depth <= deepest) return;
                deepest = std::max(deepest, std::min(depth, -shape.distance.value(point)));
            });
        return deepest;
    }

    const World& world_;
    std::map<const Shape*, Inside> inside_;
};

/// How deep is through a wall of one of the two [m]; what a plane bounds has none.
double throughWall(const World& world, BodyPair bodies)
{
    const Shape &a = world.shapeOf(bodies.a), &b = world.shapeOf(bodies.b);
    if (a.isPlane || b.isPlane) return std::numeric_limits<double>::infinity();
    return kThroughWall * std::min(a.commonThickness, b.commonThickness);
}

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
        pair.isTouched = depthOf(placePair(world, pair.bodies), 0.0) > 0.0;
    }
    const ContactGraph graph = buildContactGraph(world, settings, kSeparationStep, scratch);
    separateOverlaps(world, graph, settings, scratch);
}

/// Who counts as lying under a body.
enum class Under { heldBodies, anybody };

/// How far along `down` the first thing under a body is; nothing when there is none.
class Ground {
public:
    Ground(const World& world, const Vec3& down, Under who)
        : world_(world), down_(down), boxes_(boxesOf(world))
    {
        Aabb all;
        std::vector<BodyId> under;
        std::vector<TreeBox> boxesUnder;
        for (BodyId body = 0; body < static_cast<BodyId>(boxes_.size()); ++body) {
            const Aabb& box = boxes_[body];
            const bool isPlane = world.shapeOf(body).isPlane;
            if (!isPlane && !box.isEmpty()) all.include(box);
            const bool isHeld = world.info[body].kind != BodyKind::dynamic;
            if (box.isEmpty() || !(isHeld || who == Under::anybody)) continue;
            if (isPlane) {
                planes_.push_back(body);
            } else {
                under.push_back(body);
                boxesUnder.emplace_back(box.min, box.max);
            }
        }
        reach_ = all.isEmpty() ? 0.0 : 2.0 * all.diagonal();
        tree_.init(under.begin(), under.end(), boxesUnder.begin(), boxesUnder.end());
        isBare_ = under.empty();
    }

    std::optional<double> dropOf(BodyId body) const
    {
        std::optional<double> least;
        const auto add = [&](std::optional<double> drop) {
            if (drop && (!least || *drop < *least)) least = drop;
        };
        for (const BodyId plane : planes_) {
            if (plane != body) add(dropOnPlane(body, plane));
        }
        if (isBare_) return least;
        Aabb swept = boxes_[body];
        const Vec3 way = reach_ * down_;
        swept.include(Aabb{boxes_[body].min + way, boxes_[body].max + way});
        const auto ask = [&](BodyId under) {
            if (under != body && swept.overlaps(boxes_[under])) add(dropOnBox(body, under));
        };
        Below<decltype(ask)> below{TreeBox(swept.min, swept.max), ask};
        Eigen::BVIntersect(tree_, below);
        return least;
    }

private:
    using Tree = Eigen::KdBVH<double, 3, BodyId>;
    using TreeBox = Tree::Volume;

    /// Asks those whose boxes may meet the swept one.
    template <class Ask>
    struct Below {
        TreeBox swept;
        const Ask& ask;
        bool intersectVolume(const TreeBox& box) const { return swept.intersects(box); }
        bool intersectObject(BodyId body) const
        {
            ask(body);
            return false;  // go on
        }
    };

    std::optional<double> dropOnPlane(BodyId body, BodyId plane) const
    {
        const BodyMotion& motion = world_.motion[plane];
        const Vec3 normal = motion.orientation * Vec3::UnitY();
        const double along = -normal.dot(down_);
        if (along <= 1e-9) return std::nullopt;
        return std::max(0.0, normal.dot(world_.motion[body].position - motion.position) / along);
    }

    /// Where the way down meets the box.
    std::optional<double> dropOnBox(BodyId body, BodyId under) const
    {
        const double top =
            down_.dot(boxes_[under].centre()) - 0.5 * down_.cwiseAbs().dot(boxes_[under].size());
        const double bottom =
            down_.dot(boxes_[body].centre()) + 0.5 * down_.cwiseAbs().dot(boxes_[body].size());
        // What begins above a body's middle leans on it rather than holds it.
        const bool isBelow = top > down_.dot(boxes_[body].centre());
        if (world_.mass[under].isMovable() && !isBelow) return std::nullopt;
        return std::max(0.0, top - bottom);
    }

    const World& world_;
    Vec3 down_;
    std::vector<Aabb> boxes_;
    std::vector<BodyId> planes_;
    Tree tree_;           // of all others that may lie under a body
    bool isBare_ = true;  // it is empty
    double reach_ = 0.0;  // farther than anything is apart [m]
};

}  // namespace

std::vector<StartOverlap> findStartOverlaps(const World& world, double leastRatio)
{
    BroadPhase broadPhase;
    const std::vector<BodyPair>& pairs = broadPhase.findPairs(
        boxesOf(world), world.mass, [&](BodyPair pair) { return mayCollide(world, pair); });
    const InnerDepth innerDepth(world);
    std::vector<StartOverlap> found(pairs.size());
    parallelFor(pairs.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const auto [a, b] = pairs[i];
            const PlacedPair pair = placePair(world, pairs[i]);
            const double through = throughWall(world, pairs[i]);
            const double least = std::min(leastRatio * smallerEdge(world, a, b), through);
            if (apartAtLeast(pair) > -least) continue;
            const double depth = innerDepth(a, b, std::max(depthOf(pair, least), least));
            if (depth <= least) continue;
            found[i] = {a, b, depth, overlapRatio(world, pairs[i], depth), depth > through};
        }
    });
    std::vector<StartOverlap> overlaps;
    std::copy_if(found.begin(), found.end(), std::back_inserter(overlaps),
                 [](const StartOverlap& overlap) { return overlap.depth > 0.0; });
    std::stable_sort(overlaps.begin(), overlaps.end(),
                     [](const auto& p, const auto& q) { return p.ratio > q.ratio; });
    return overlaps;
}

bool separateAtStart(World& world, const StepSettings& settings, double leastRatio)
{
    // Velocities would tell the graph of falls that have nothing to do with who lies on whom.
    const std::vector<BodyMotion> before = world.motion;
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
    bool isApart = findStartOverlaps(world, 0.5 * leastRatio).empty();
    for (int round = 0; round < kMostRounds && !isApart; ++round) {
        separateOnce(world, settings);
        isApart = findStartOverlaps(world, 0.5 * leastRatio).empty();
    }
    for (std::size_t body = 0; body < before.size(); ++body) {
        world.motion[body].velocity = before[body].velocity;
        world.motion[body].angularMomentum = before[body].angularMomentum;
    }
    sleepFromTheStart(world, settings, sleepers);
    return isApart;
}

std::vector<BodyId> findUnsupported(const World& world, const Vec3& gravity)
{
    std::vector<BodyId> unsupported;
    if (gravity.isZero(0.0)) return unsupported;
    const Ground ground(world, gravity.normalized(), Under::heldBodies);
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        if (world.mass[body].isMovable() && !ground.dropOf(body)) unsupported.push_back(body);
    }
    return unsupported;
}

std::vector<FastBody> findTooFast(const World& world, const StepSettings& settings,
                                  double frameDuration)
{
    std::vector<FastBody> fast;
    const double g = settings.gravity.norm();
    const Vec3 down = g > 0.0 ? settings.gravity.normalized().eval() : Vec3::Zero().eval();
    const Ground ground(world, down, Under::anybody);
    for (BodyId body = 0; body < static_cast<BodyId>(world.bodyCount()); ++body) {
        if (!world.mass[body].isMovable()) continue;
        const Shape& shape = world.shapeOf(body);
        const double v = world.motion[body].velocity.norm();
        const double spin = shownSpin(world, settings, body);
        const double drop = g > 0.0 ? ground.dropOf(body).value_or(0.0) : 0.0;
        const double landing = std::sqrt(v * v + 2.0 * g * drop);
        const double way = settings.substeps.safety * passedPerStep(settings.method, shape);
        const auto stepsAt = [&](double speed) {
            return frameDuration * (speed + spin * shape.boundingRadius) / way;
        };
        const bool isAtStart = stepsAt(v) > settings.substeps.max;
        const double speed = isAtStart ? v : landing;
        if (stepsAt(speed) <= settings.substeps.max) continue;
        fast.push_back({body, speed + spin * shape.boundingRadius, stepsAt(speed), !isAtStart});
    }
    std::stable_sort(fast.begin(), fast.end(), [](const FastBody& p, const FastBody& q) {
        return p.stepsNeeded > q.stepsNeeded;
    });
    return fast;
}

}  // namespace scree
