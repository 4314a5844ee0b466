// The impacts of a step of method `scree`, pair by pair: what is hit, when, and what it does to its
// bodies.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/dynamics/gaps/gap_held.h"
#include "core/dynamics/gaps/gap_scratch.h"
#include "core/dynamics/gaps/gap_together.h"

namespace scree {

/// The clock of an island when its visits begin.
inline constexpr std::int64_t kBeforeAll = 1;

/// What the impacts of this step have done to a body so far. Two cache lines, since they are
/// fetched by twos: two threads write to neighbours.
struct alignas(128) ImpactChange {
    Vec3 velocity = Vec3::Zero(), spin = Vec3::Zero();  // change
    Vec3 shift = Vec3::Zero(), turn = Vec3::Zero();     // by blows at their own moments
    bool isByFixed = true;                              // all blows so far
    double earliest = std::numeric_limits<double>::infinity();
    std::int64_t changedAt = 0;  // the visit of a pair that changed it last
};

struct Impact {
    GapRow* row;
    bool isCarried;             // as its pair
    Vec3 velocity;              // relative, at the moment of impact
    double time;                // within the step
    double velocityAfter;       // normal velocity that makes it leave as it must
    Vec3 slid = Vec3::Zero();   // what its lever arms have allowed for
    bool onlyPrecedes = false;  // a later blow; without one it is left to contacts
};

struct FirstHit {
    double time;   // within the step
    double speed;  // [m/s]
};

/// The pairs of a block by the places of their movable bodies, in the order of visits.
class PairsOfBodies {
public:
    PairsOfBodies(const GapBlock& block, const GapScratch& scratch);

    std::span<const std::size_t> of(std::int32_t place) const
    {
        return std::span(pairs_).subspan(begin_[place], begin_[place + 1] - begin_[place]);
    }

private:
    std::vector<std::size_t> begin_, pairs_;
};

/// What is known of the impacts of a block, by the places of bodies and pairs in it. Visits of
/// pairs that share no movable body read and write different parts of it.
struct ImpactState {
    ImpactState(const StepSettings& stepSettings, double stepLength,
                const std::vector<Held>& heldAsBefore, const GapBlock& ofBlock, GapScratch& ofStep);

    std::int32_t placeOf(BodyId body) const { return scratch.placeInBlock[body]; }
    void findPairsOfBodies() { pairsOf_.emplace(block, scratch); }
    const PairsOfBodies& pairsOfBodies() const { return *pairsOf_; }

    const StepSettings& settings;
    double dt, slowest;
    const GapBlock& block;
    GapScratch& scratch;
    const std::vector<Held>& held;
    std::vector<ImpactChange> changes;
    // Of each pair, by the clock of its island: the last visit that ended with nothing left to be
    // hit, 0: none; and the last look at it.
    std::vector<std::int64_t> doneAt, gatheredAt;

private:
    std::optional<PairsOfBodies> pairsOf_;
};

/// Visits pairs one by one. Two lines of the cache apart: the visits of halves are written to by
/// two threads.
class alignas(128) ImpactVisits {
public:
    /// `half`: of pairs of one half. Those whose blows may reach the other are left to somebody
    /// else.
    enum class Of { all, half };
    ImpactVisits(ImpactState& state, Of pairs)
        : state_(state), scratch_(state.scratch), isOfHalf_(pairs == Of::half)
    {
    }

    /// Those that were left since the last call.
    std::vector<std::size_t> takeLeft() { return std::exchange(left_, {}); }

    /// Ticks with what is found and done: a pair is done with until one of its bodies has changed
    /// since. Who goes on with the pairs of others goes on with the latest of their clocks.
    std::int64_t clock() const { return clock_; }
    void setClock(std::int64_t clock) { clock_ = clock; }

    const std::vector<GapImpact>& impacts() const { return noted_; }
    std::vector<GapImpact> takeImpacts() { return std::exchange(noted_, {}); }

    /// What is hit again within a step and would leave no faster than this is left to contacts
    /// [m/s].
    void setLeastRebound(double speed) { leastRebound_ = speed; }

    /// When the first row of a pair will be hit, and how fast the fastest; nothing if none will.
    std::optional<FirstHit> firstHitOf(const GapPair& pair) const;

    void visit(std::size_t p)
    {
        const GapPair& pair = scratch_.pairs[p];
        const std::int64_t changedAt =
            std::max(changeOf(pair.bodies.a).changedAt, changeOf(pair.bodies.b).changedAt);
        if (state_.doneAt[pair.place] > changedAt) return;
        if (resolvePair(p)) state_.doneAt[pair.place] = ++clock_;
    }

private:
    ImpactChange& changeOf(BodyId body) { return state_.changes[state_.placeOf(body)]; }
    Vec3 gravityAt(const GapRow& row) const;
    bool impactOf(const GapPair& pair, GapRow& row, Impact& impact) const;
    bool resolvePair(std::size_t p);
    bool gather(std::size_t p, std::vector<Impact>& hits);
    double gatherFirst(std::size_t p, std::vector<Impact>& hits) const;
    Vec3 slideUntil(const Impact& impact) const;
    GapRow rowAt(Impact& impact) const;
    void applyOne(Impact& impact);
    void applyTogether(std::vector<Impact>& hits);
    void note(const Impact& impact, const GapRow& row, const Vec3& impulse, FrictionCase kind);
    void applyImpulses(const GapRow& row, const Vec3& impulse, double time);
    void applyTo(GapBody& body, const Vec3& r, const Vec3& impulse, ImpactChange& change,
                 double time);

    ImpactState& state_;
    GapScratch& scratch_;
    std::int64_t clock_ = kBeforeAll;
    bool isOfHalf_;
    double leastRebound_ = 0.0;
    std::vector<std::size_t> left_;
    std::vector<GapImpact> noted_;
};

}  // namespace scree
