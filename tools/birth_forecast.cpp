// Symbols: x centre of mass, v velocity, w angular velocity, g gravity, t since birth [s].
#include "tools/birth_forecast.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>

#include "core/dynamics/births.h"
#include "core/dynamics/body_pairs.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// Tests of one body against another, some ten microseconds each. Who waits is tested in every
/// frame: where hundreds do, the rest of the shot is foretold from the part that was tried.
constexpr std::int64_t kMostTests = 50'000;

/// And of boxes, a few nanoseconds each.
constexpr std::int64_t kMostBoxTests = 200'000'000;

/// What becomes of the bodies of one emitter.
struct Births {
    int all = 0, come = 0;
    int blocked = 0;  ///< for ever, by something static
    int comeAtOnce = 0;
    bool isWaiting = true;  ///< for its place, not left out
    SourceLocation location;
};

/// Lets bodies be born that meet nothing afterwards.
class Forecast {
public:
    Forecast(const Shot& shot, const World& world) : shot_(shot), world_(world)
    {
        for (BodyId body = 0; body < static_cast<BodyId>(world_.bodyCount()); ++body)
            if (world_.info[body].kind != BodyKind::dynamic) there_.push_back(body);
        for (const PlannedBirth& birth : world_.births) {
            Births& births = births_[shot_.bodies[birth.body].item];
            ++births.all;
            births.come += world_.isBorn(birth.body);
            births.comeAtOnce = births.come;
            births.isWaiting = birth.clearance == BirthClearance::wait;
            births.location = shot_.bodies[birth.body].location;
            starts_[birth.body] = world_.motion[birth.body];
            if (world_.isBorn(birth.body)) there_.push_back(birth.body);
        }
    }

    /// By the last frame, or as it will be if it goes on as in the frames that could be tried.
    std::map<std::string, Births> run()
    {
        const int last = shot_.lastFrame - shot_.firstFrame;
        for (int frame = 1; (frame = nextWithBirths(frame)) <= last; ++frame) {
            moveTo(frame);
            for (const PlannedBirth& birth : world_.births)
                if (birth.frame <= frame && world_.bornAt[birth.body] == kUnborn) attempt(birth);
            if (!isTired()) continue;
            for (auto& [item, births] : births_) {
                const double rate = static_cast<double>(births.come - births.comeAtOnce) / frame;
                births.come = std::min(births.all - births.blocked,
                                       births.come + static_cast<int>(rate * (last - frame)));
            }
            break;
        }
        return births_;
    }

    /// Whether the end was not reached.
    bool isTired() const { return tests_ > kMostTests || boxTests_ > kMostBoxTests; }

private:
    /// The first from `frame` on at which somebody is due.
    int nextWithBirths(int frame) const
    {
        std::int64_t next = std::numeric_limits<int>::max();
        for (const PlannedBirth& birth : world_.births)
            if (world_.bornAt[birth.body] == kUnborn)
                next = std::min(next, std::max<std::int64_t>(frame, birth.frame));
        return static_cast<int>(next);
    }

    /// Everything flies, keyed bodies follow their keys. Who has left the places of those to come
    /// is forgotten.
    void moveTo(int frame)
    {
        world_.clock.frame = frame;
        Aabb places;
        for (const PlannedBirth& birth : world_.births)
            if (world_.bornAt[birth.body] == kUnborn) places.include(boxOf(world_, birth.body));
        boxes_.clear();
        std::erase_if(there_, [&](BodyId body) {
            move(body, frame);
            const Aabb box = boxOf(world_, body);
            const bool isGone = starts_.contains(body) && !box.overlaps(places);
            if (!isGone) boxes_.push_back(box);
            return isGone;
        });
    }

    void move(BodyId body, int frame)
    {
        BodyMotion& now = world_.motion[body];
        if (world_.info[body].script) {
            const Pose pose = world_.scriptedPose(body, world_.time());
            now.position = pose.position;
            now.orientation = pose.orientation;
        }
        const auto start = starts_.find(body);
        if (start == starts_.end()) return;
        const double t = (frame - world_.bornAt[body]) / shot_.framesPerSecond;
        const Vec3 &v = start->second.velocity, &w = shot_.bodies[body].angularVelocity;
        now.position = start->second.position + t * v + 0.5 * t * t * shot_.settings.gravity;
        now.orientation = exponentialMap(t * w) * start->second.orientation;
    }

    void attempt(const PlannedBirth& birth)
    {
        Births& births = births_[shot_.bodies[birth.body].item];
        const Aabb box = boxOf(world_, birth.body);
        for (std::size_t i = 0; i < there_.size(); ++i) {
            ++boxTests_;
            if (!box.overlaps(boxes_[i])) continue;
            ++tests_;
            if (!standsInTheWay(world_, there_[i], birth.body)) continue;
            const bool isForEver = world_.info[there_[i]].kind == BodyKind::fixed;
            births.blocked += isForEver;
            if (isForEver || birth.clearance != BirthClearance::wait)
                world_.bornAt[birth.body] = kSkipped;
            return;
        }
        world_.beBorn(birth);
        ++births.come;
        there_.push_back(birth.body);
        boxes_.push_back(box);
    }

    const Shot& shot_;
    World world_;
    std::map<std::string, Births> births_;  // by emitter
    std::map<BodyId, BodyMotion> starts_;   // of who is emitted: at its birth
    std::vector<BodyId> there_;             // in the way of others
    std::vector<Aabb> boxes_;               // parallel to there_
    std::int64_t tests_ = 0, boxTests_ = 0;
};

}  // namespace

std::vector<std::string> foretellBirths(const Shot& shot, const World& world)
{
    if (world.births.empty() || !world.fields.empty()) return {};
    Forecast forecast(shot, world);
    std::vector<std::string> sentences;
    for (const auto& [item, births] : forecast.run()) {
        const int late = births.all - births.come - births.blocked;
        if (late <= 0) continue;
        sentences.push_back(
            toString(births.location) + ": " + (forecast.isTired() ? "about " : "at least ") +
            std::to_string(late) + " of the " + std::to_string(births.all) +
            " bodies of emitter '" + item + "' " +
            (births.isWaiting ? "still wait at the last frame, " + std::to_string(shot.lastFrame)
                              : "are left out") +
            ", because those before them have not left their places: give it more places or "
            "frames, or a velocity that clears them sooner");
    }
    return sentences;
}

}  // namespace scree
