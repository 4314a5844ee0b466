// Symbols: s gap, u normal velocity (approaching < 0), g relative acceleration along the normal,
//          t time of impact within the step, e restitution.
//
// The paper bounces a body where it is when its prediction interferes: up to v dt too early, and an
// elastic bounce loses v dt of height. Here the gap says when the surfaces meet. The speed there
// decides the impulse, and the body moves with its old velocity until then, so that a bounce is
// right to rounding at any step length.  [A28]
//
// No threshold velocity decides what bounces. But a bounce that is over before the step ends cannot
// be shown: if gravity would bring the body back within the rest of the step, it does not bounce.
// Heaps that come to rest do it here, at speeds of g dt.
//
// What is hit from two sides at once is solved at once. One pair after the other, the first made
// two balls that ran into a third from either side leave with speeds a tenth apart. Blows that
// follow from each other still run on pair by pair: solved at once they would not pass along a row.
#include "core/dynamics/gap_bounce.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "core/dynamics/contact_point.h"
#include "core/dynamics/friction.h"
#include "core/dynamics/gap_contact.h"

namespace scree {
namespace {

constexpr int kMostPairSweeps = 20;
constexpr double kPairIsSolved = 1e-4;  // of the speed of the impact

/// Places that are hit within this share of a step are hit together.
constexpr double kTogether = 0.01;

/// What the impacts of this step have done to a body so far.
struct Impacts {
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();  // change
    double earliest = std::numeric_limits<double>::infinity();
    std::int64_t changedAt = 0;  // the visit of a pair that changed it last
};

/// What accelerates a body beside what pulls it.
struct Held {
    Vec3 acceleration = Vec3::Zero(), turning = Vec3::Zero();  // [m/s²], [rad/s²]
};

/// Per body, if all that carried it in the last step does so again: rows begin with the impulses
/// that are remembered.
std::vector<Held> heldAsBefore(double dt, const GapScratch& scratch)
{
    std::vector<Held> held(scratch.bodies.size());
    const auto hold = [&](BodyId body, const Vec3& r, const Vec3& force, const Vec3& couple) {
        held[body].acceleration += scratch.bodies[body].inverseMass * force;
        held[body].turning += scratch.bodies[body].inverseInertia * (r.cross(force) + couple);
    };
    for (const std::size_t p : scratch.order) {
        for (std::size_t r = scratch.pairs[p].begin; r < scratch.pairs[p].end; ++r) {
            const GapRow& row = scratch.rows[r];
            if (row.impulse.x() == 0.0) continue;
            const Vec3 force = row.worldImpulse() / dt, couple = row.couple / dt;
            if (row.movesA) hold(row.a, row.rA, force, couple);
            if (row.movesB) hold(row.b, row.rB, -force, -couple);
        }
    }
    return held;
}

struct Impact {
    GapRow* row;
    Vec3 velocity;             // relative, at the moment of impact
    double time;               // within the step
    double velocityAfter;      // normal velocity that makes it leave as it must
    Vec3 slid = Vec3::Zero();  // what its lever arms have allowed for
};

/// The pairs that have rows, by movable body, in the order of visits.
class PairsOfBodies {
public:
    explicit PairsOfBodies(const GapScratch& scratch) : begin_(scratch.bodies.size() + 1, 0)
    {
        const auto forBodies = [&](const auto& visit) {
            for (const std::size_t i : scratch.order) {
                for (const BodyId body : {scratch.pairs[i].bodies.a, scratch.pairs[i].bodies.b}) {
                    if (scratch.bodies[body].inverseMass > 0.0) visit(body, i);
                }
            }
        };
        forBodies([&](BodyId body, std::size_t) { ++begin_[body + 1]; });
        for (std::size_t b = 1; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
        pairs_.resize(begin_.back());
        std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
        forBodies([&](BodyId body, std::size_t i) { pairs_[next[body]++] = i; });
    }

    std::span<const std::size_t> of(BodyId body) const
    {
        return std::span(pairs_).subspan(begin_[body], begin_[body + 1] - begin_[body]);
    }

private:
    std::vector<std::size_t> begin_, pairs_;
};

class ImpactPass {
public:
    ImpactPass(const StepSettings& settings, double dt, GapScratch& scratch)
        : settings_(settings),
          dt_(dt),
          slowest_(slowestApproach(settings, dt)),
          scratch_(scratch),
          held_(heldAsBefore(dt, scratch)),
          impacts_(scratch.bodies.size()),
          doneAt_(scratch.pairs.size(), 0),
          gatheredAt_(scratch.pairs.size(), 0),
          placeOf_(scratch.bodies.size(), -1)
    {
        scratch.impacts.clear();
    }

    ImpulseCounts run(std::int64_t& loopsAtTheirCap)
    {
        ImpulseCounts counts;
        for (const std::size_t i : inOrderOfTime()) visit(i, counts);
        for (int sweep = 0; sweep < settings_.collisionIterations; ++sweep) {
            const std::int64_t before = counts.total();
            // There and back: a blow runs along a row of touching bodies whichever way it lies.
            for (std::size_t i : scratch_.order) visit(i, counts);
            for (std::size_t p = scratch_.order.size(); p-- > 0;) visit(scratch_.order[p], counts);
            if (counts.total() == before) return counts;
        }
        ++loopsAtTheirCap;
        return counts;
    }

private:
    /// The pairs that are going to be hit, the first first: a body that moves on as it did until
    /// its blow would run through what it meets before. Most pairs are hit by nothing yet: they are
    /// done until a blow comes to one of their bodies.
    std::vector<std::size_t> inOrderOfTime()
    {
        ++visits_;
        std::vector<double> times(scratch_.pairs.size(), -1.0);
        forPairs(scratch_, [&](std::size_t p) {
            const GapPair& pair = scratch_.pairs[p];
            Impact impact{};
            for (std::size_t r = pair.begin; r < pair.end; ++r) {
                if (!impactOf(scratch_.rows[r], impact)) continue;
                times[p] = times[p] < 0.0 ? impact.time : std::min(times[p], impact.time);
            }
            if (times[p] < 0.0) doneAt_[p] = visits_;
        });
        std::vector<std::size_t> hit;
        for (const std::size_t p : scratch_.order) {
            if (times[p] >= 0.0) hit.push_back(p);
        }
        std::stable_sort(hit.begin(), hit.end(),
                         [&](std::size_t p, std::size_t q) { return times[p] < times[q]; });
        return hit;
    }

    /// What lies on something does not fall on what lies a hair below it: of gravity only that
    /// brings the two together which what held their bodies in the last step would let through now.
    /// A ring that hung on three corners of a pole fell on a fourth 0.4 mm away, through the three,
    /// and was pushed out again, step after step.
    Vec3 gravityAt(const GapRow& row) const
    {
        const Vec3 free = scratch_.bodies[row.a].pull - scratch_.bodies[row.b].pull;
        const double g = free.dot(row.normal);
        if (g >= 0.0) return free;
        const Held &a = held_[row.a], &b = held_[row.b];
        const Vec3 held =
            a.acceleration + a.turning.cross(row.rA) - b.acceleration - b.turning.cross(row.rB);
        return free + std::clamp(held.dot(row.normal), 0.0, -g) * row.normal;
    }

    /// False when the row is not going to be hit within the step.
    bool impactOf(GapRow& row, Impact& impact) const
    {
        const GapBody& a = scratch_.bodies[row.a];
        const GapBody& b = scratch_.bodies[row.b];
        const Vec3 relative = velocityAt(row, a, b);
        const double u = relative.dot(row.normal);
        const double s = std::max(row.gap, 0.0);
        const double atRest = s + shiftAt(row, a, b);
        const auto end = [&](double g) { return atRest + dt_ * (u + 0.5 * g * dt_); };
        // Most rows are not even closed by all of gravity.
        if (end((a.pull - b.pull).dot(row.normal)) >= 0.0) return false;
        const Vec3 gravity = gravityAt(row);
        const double g = gravity.dot(row.normal);
        if (end(g) >= 0.0) return false;
        const double root = u * u - 2.0 * g * s;
        if (root < 0.0) return false;
        // Once hit, what it hits again in the same step was not a fall: the parabola is used up.
        // What all of gravity would bring back within the step bounces no more: in a heap each blow
        // makes many such, and they would go on for ever.
        if (row.wasHit) {
            const double fall = dt_ * std::max(a.pull.norm(), b.pull.norm());
            if (u >= -slowest_ || 2.0 * row.restitution * -u <= fall) return false;
            impact = {&row, relative, 0.0, -row.restitution * u, Vec3::Zero()};
            return true;
        }
        const double closing = -u + std::sqrt(root);
        if (s > 0.0 && closing <= 0.0) return false;  // only the shifts bring them together
        const double time = s > 0.0 ? std::min(2.0 * s / closing, dt_) : 0.0;
        const double speed = u + g * time;
        if (speed >= -slowest_) return false;
        // What lies on something that lies on the ground falls back on it with all of gravity, even
        // if both are free to fall.
        const double pull = row.isCarried ? std::max(a.pull.norm(), b.pull.norm())
                                          : (b.pull - a.pull).dot(row.normal);
        if (2.0 * row.restitution * -speed <= pull * (dt_ - time)) return false;
        impact = {&row, relative + time * gravity, time, u - (1.0 + row.restitution) * speed,
                  Vec3::Zero()};
        return true;
    }

    void visit(std::size_t p, ImpulseCounts& counts)
    {
        const auto [a, b] = scratch_.pairs[p].bodies;
        const std::int64_t changedAt = std::max(impacts_[a].changedAt, impacts_[b].changedAt);
        if (doneAt_[p] > changedAt) return;
        if (resolvePair(p, counts)) doneAt_[p] = ++visits_;
    }

    /// True when nothing is left to be hit.
    bool resolvePair(std::size_t p, ImpulseCounts& counts)
    {
        for (int n = 0; n < settings_.collisionPairImpulses; ++n) {
            gather(p);
            if (hits_.empty()) return true;
            for (const Impact& hit : hits_) hit.row->wasHit = true;
            if (hits_.size() == 1) {
                applyOne(hits_[0], counts);
            } else {
                applyTogether(counts);
            }
        }
        return false;
    }

    /// Whether what hits there has come from afar in this step: it was neither hit already nor did
    /// its bodies lie on each other.
    static bool arrives(const GapRow& row) { return !row.wasHit && !row.isCarried; }

    /// Fills hits_ with the first impacts of a pair, and those that come to its bodies, and on to
    /// the others of these, at the same time.
    void gather(std::size_t p)
    {
        hits_.clear();
        const double time = gatherFirst(p);
        if (hits_.empty() || !arrives(*hits_[0].row)) return;
        ++gathers_;
        gatheredAt_[p] = gathers_;
        toSpread_ = {scratch_.pairs[p].bodies.a, scratch_.pairs[p].bodies.b};
        while (!toSpread_.empty()) {
            const BodyId body = toSpread_.back();
            toSpread_.pop_back();
            for (const std::size_t q : pairsOf(body)) {
                if (gatheredAt_[q] == gathers_ || scratch_.rows[scratch_.pairs[q].begin].isCarried)
                    continue;
                gatheredAt_[q] = gathers_;
                const std::size_t before = hits_.size();
                gatherFirst(q);
                dropHits(before, [&](const Impact& hit) {
                    return !arrives(*hit.row) || std::abs(hit.time - time) > kTogether * dt_;
                });
                const auto [a, b] = scratch_.pairs[q].bodies;
                if (hits_.size() > before) toSpread_.push_back(a == body ? b : a);
            }
        }
    }

    std::span<const std::size_t> pairsOf(BodyId body)
    {
        if (!pairsOf_) pairsOf_.emplace(scratch_);
        return pairsOf_->of(body);
    }

    /// Of all places of a pair that would be hit, those that are hit first: what would follow may
    /// not, once these are answered. Answers their time.
    double gatherFirst(std::size_t p)
    {
        const GapPair& pair = scratch_.pairs[p];
        const std::size_t before = hits_.size();
        double earliest = dt_;
        Impact impact{};
        for (std::size_t r = pair.begin; r < pair.end; ++r) {
            if (!impactOf(scratch_.rows[r], impact)) continue;
            hits_.push_back(impact);
            earliest = std::min(earliest, impact.time);
        }
        dropHits(before, [&](const Impact& hit) { return hit.time > earliest + kTogether * dt_; });
        return earliest;
    }

    template <class Which>
    void dropHits(std::size_t from, const Which& which)
    {
        const auto begin = hits_.begin() + static_cast<std::ptrdiff_t>(from);
        hits_.erase(std::remove_if(begin, hits_.end(), which), hits_.end());
    }

    /// How far the centres slide along each other until the impact, if both are free to.
    Vec3 slideUntil(const Impact& impact) const
    {
        const GapRow& row = *impact.row;
        if (!row.movesA || !row.movesB) return Vec3::Zero();
        return impact.time * (scratch_.bodies[row.a].velocity - scratch_.bodies[row.b].velocity);
    }

    /// The row of an impact with the lever arms it has then: the place goes along with both.
    /// Angular momentum is kept so, and energy too. Keeps the arms of now where they alone see it
    /// coming.
    GapRow rowAt(Impact& impact) const
    {
        GapRow row = *impact.row;
        const GapBody& a = scratch_.bodies[row.a];
        const GapBody& b = scratch_.bodies[row.b];
        const Vec3 slid = slideUntil(impact);
        row.impulse = Vec3::Zero();
        row.target = impact.velocityAfter;
        impact.slid = Vec3::Zero();
        if (slid.isZero(0.0)) return row;
        row.rA -= 0.5 * slid;
        row.rB += 0.5 * slid;
        const Vec3 velocity = velocityAt(row, a, b) + impact.time * gravityAt(row);
        const double speed = velocity.dot(row.normal);
        if (speed >= -slowest_) {
            row.rA = impact.row->rA;
            row.rB = impact.row->rB;
            return row;
        }
        prepareRow(scratch_, row);
        row.target = velocityAt(row, a, b).dot(row.normal) - (1.0 + row.restitution) * speed;
        impact.velocity = velocity;
        impact.slid = slid;
        return row;
    }

    void applyOne(Impact& impact, ImpulseCounts& counts)
    {
        const GapRow row = rowAt(impact);
        const GapBody& a = scratch_.bodies[row.a];
        const GapBody& b = scratch_.bodies[row.b];
        const Mat3 k =
            collisionMatrix(
                row.movesA ? PassInertia{a.inverseMass, a.inverseInertia} : PassInertia{}, row.rA) +
            collisionMatrix(
                row.movesB ? PassInertia{b.inverseMass, b.inverseInertia} : PassInertia{}, row.rB);
        const ContactImpulse j =
            contactImpulse(k, impact.velocity, row.normal, row.restitution, row.friction);
        applyImpulses(row, j.impulse, impact.time);
        note(impact, j.impulse);
        countImpulse(counts, j.kind);
    }

    /// A face that lands flat is hit at all its corners at once. One by one they would make it
    /// spin. With friction, Newton's rule at several places can add energy, again and again;
    /// without it cannot, and that is what is left then.
    void applyTogether(ImpulseCounts& counts)
    {
        double earliest = dt_;
        for (const Impact& impact : hits_) earliest = std::min(earliest, impact.time);
        if (solveTogether(true) > 0.0) solveTogether(false);
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            applyImpulses(rows_[i], rows_[i].worldImpulse(), earliest);
            note(hits_[i], rows_[i].worldImpulse());
            ++counts.sticking;
        }
    }

    /// Fills rows_ with the impulses of hits_; answers their work [J].
    double solveTogether(bool withFriction)
    {
        rows_.clear();
        after_.clear();
        hitBodies_.clear();
        double fastest = 0.0;
        for (Impact& impact : hits_) {
            rows_.push_back(rowAt(impact));
            if (!withFriction) rows_.back().friction = 0.0;
            fastest = std::max(fastest, impact.velocity.norm());
            for (const BodyId body : {impact.row->a, impact.row->b}) {
                if (placeOf_[body] >= 0) continue;
                placeOf_[body] = static_cast<std::int32_t>(after_.size());
                hitBodies_.push_back(body);
                after_.push_back(scratch_.bodies[body]);
            }
        }
        const auto after = [&](BodyId body) -> GapBody& { return after_[placeOf_[body]]; };
        for (int sweep = 0; sweep < kMostPairSweeps; ++sweep) {
            double residual = 0.0;
            for (GapRow& row : rows_)
                residual = std::max(residual, visitRow(row, after(row.a), after(row.b)));
            if (residual <= kPairIsSolved * fastest) break;
        }
        double work = 0.0;
        for (const GapRow& row : rows_) {
            const Vec3 before = velocityAt(row, scratch_.bodies[row.a], scratch_.bodies[row.b]);
            work +=
                0.5 * row.worldImpulse().dot(before + velocityAt(row, after(row.a), after(row.b)));
        }
        for (const BodyId body : hitBodies_) placeOf_[body] = -1;
        return work;
    }

    void note(const Impact& impact, const Vec3& impulse)
    {
        scratch_.impacts.push_back(
            {static_cast<std::size_t>(impact.row - scratch_.rows.data()), impulse, impact.slid});
    }

    void applyImpulses(const GapRow& row, const Vec3& impulse, double time)
    {
        if (row.movesA) applyTo(scratch_.bodies[row.a], row.rA, impulse, impacts_[row.a], time);
        if (row.movesB) applyTo(scratch_.bodies[row.b], row.rB, -impulse, impacts_[row.b], time);
    }

    void applyTo(GapBody& body, const Vec3& r, const Vec3& impulse, Impacts& impacts, double time)
    {
        const Vec3 dv = body.inverseMass * impulse;
        const Vec3 dw = body.inverseInertia * r.cross(impulse);
        body.velocity += dv;
        body.spin += dw;
        body.angularImpulse += r.cross(impulse);
        impacts.velocity += dv;
        impacts.spin += dw;
        impacts.earliest = std::min(impacts.earliest, time);
        impacts.changedAt = visits_;
        body.hitAt = impacts.earliest;
        body.shift = -impacts.earliest * impacts.velocity;
        body.turn = -impacts.earliest * impacts.spin;
    }

    const StepSettings& settings_;
    double dt_, slowest_;
    GapScratch& scratch_;
    std::optional<PairsOfBodies> pairsOf_;  // once asked for
    std::vector<Held> held_;
    std::vector<Impacts> impacts_;
    std::int64_t visits_ = 0;           // that ended with nothing left to be hit
    std::vector<std::int64_t> doneAt_;  // the last of them, of each pair; 0: none
    std::int64_t gathers_ = 0;
    std::vector<std::int64_t> gatheredAt_;  // the last look at each pair
    std::vector<BodyId> toSpread_;
    std::vector<Impact> hits_;
    std::vector<GapRow> rows_;           // of hits_
    std::vector<BodyId> hitBodies_;      // of hits_
    std::vector<GapBody> after_;         // these
    std::vector<std::int32_t> placeOf_;  // of a body in after_; −1: not hit
};

}  // namespace

ImpulseCounts resolveImpacts(const StepSettings& settings, double dt, GapScratch& scratch,
                             std::int64_t& loopsAtTheirCap)
{
    return ImpactPass(settings, dt, scratch).run(loopsAtTheirCap);
}

}  // namespace scree
