// Symbols: g gravity, down its direction, drop the way to what lies under a body.
#include "core/dynamics/start_check.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unsupported/Eigen/BVH>

#include "core/dynamics/body_pairs.h"
#include "core/dynamics/start_overlap.h"
#include "core/dynamics/step_limit.h"

namespace scree {
namespace {

/// Who counts as lying under a body.
enum class Under { heldBodies, anybody };

/// How far along `down` the first thing under a body is; nothing when there is none.
class Ground {
public:
    Ground(const World& world, const Vec3& down, Under who)
        : world_(world), down_(down), boxes_(startBoxes(world))
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
            if (plane != body && acceptEachOther(world_, {body, plane}))
                add(dropOnPlane(body, plane));
        }
        if (isBare_) return least;
        Aabb swept = boxes_[body];
        const Vec3 way = reach_ * down_;
        swept.include(Aabb{boxes_[body].min + way, boxes_[body].max + way});
        const auto ask = [&](BodyId under) {
            if (under != body && swept.overlaps(boxes_[under]) &&
                acceptEachOther(world_, {body, under}))
                add(dropOnBox(body, under));
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
        const auto stepsAt = [&](double speed) {
            return stepsToPass(settings, shape, speed + spin * shape.boundingRadius, frameDuration);
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
