// In which order impacts are answered. What is hit first is answered first, then blows run on: over
// all pairs of an island there and back, until nothing more is hit. Islands share no body and go at
// once; the halves of a large one too, but for blows that may reach the other half.
#include "core/dynamics/gaps/gap_bounce.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "core/base/parallel.h"
#include "core/dynamics/gaps/gap_impacts.h"
#include "core/dynamics/gaps/gap_overrun.h"
#include "core/dynamics/gaps/gap_pairs.h"

namespace scree {
namespace {

/// Where fewer pairs are hit at first, few are in all.
constexpr std::size_t kHitsWorthACut = 32;

/// In a heap each blow comes back from all sides, again and again and slower each time. What is hit
/// again is answered if it leaves with more than this share of the fastest blow on its island.
/// While a thousand coins pour into a chest that halves the time spent here, and rings come to rest
/// as soon.
constexpr double kLeastRebound = 0.01;

/// Sweeps end when nothing is hit any more; in heaps nearly always after a few. But what drives a
/// light body against a wall meets it the more often the heavier it is, and what is cut off is left
/// to contacts, which know no rebound: a ball that did so to one of a thirtieth of its mass lost
/// half its energy, one to a hundredth all of it.
constexpr int kSweepsPerIteration = 20;

/// A pair that is going to be hit.
struct PairToHit {
    std::size_t pair;
    FirstHit first;
};

/// The impacts of an island.
class IslandImpacts {
public:
    IslandImpacts(ImpactState& state, const GapIsland& island, bool mayCut) : state_(state)
    {
        if (mayCut)
            parts_ = partsOf(state.scratch, island, roomForParts_);
        else
            parts_[0] = island.pairs;
        isCut_ = !parts_[1].empty();
    }

    /// `toHit`: the pairs that are going to be hit, the first first. A body that moves on as it did
    /// until its blow would run through what it meets before.
    void run(std::span<const PairToHit> toHit)
    {
        double fastest = 0.0;
        for (const PairToHit& next : toHit) fastest = std::max(fastest, next.first.speed);
        for (ImpactVisits* visits : {&whole_, &halves_[0], &halves_[1]})
            visits->setLeastRebound(kLeastRebound * fastest);
        for (const PairToHit& next : toHit) whole_.visit(next.pair);
        const int most = kSweepsPerIteration * state_.settings.collisionIterations;
        for (int sweep = 0; sweep < most && !isOver_; ++sweep) {
            const std::size_t before = count();
            sweepThereAndBack();
            isOver_ = count() == before;
        }
        if (!isOver_) leaveToContacts();
    }

    bool isOver() const { return isOver_; }
    /// Hands over what was noted.
    std::vector<GapImpact> takeImpacts()
    {
        std::vector<GapImpact> all = whole_.takeImpacts();
        for (const ImpactVisits& half : halves_)
            all.insert(all.end(), half.impacts().begin(), half.impacts().end());
        return all;
    }

private:
    /// What is still going to be hit is stopped by contacts, which press for the whole step: until
    /// its blow it cannot have gone another way. Eight tons that fell on a block on the floor sank
    /// into it by a quarter of its size.
    void leaveToContacts()
    {
        for (const std::span<const std::size_t> part : parts_) {
            for (const std::size_t p : part) {
                const GapPair& pair = state_.scratch.pairs[p];
                if (!whole_.firstHitOf(pair)) continue;
                for (const BodyId body : {pair.bodies.a, pair.bodies.b}) {
                    GapBody& left = state_.scratch.bodies[body];
                    if (left.isMovable()) moveFromTheStart(left);
                }
            }
        }
    }
    std::size_t count() const
    {
        return whole_.impacts().size() + halves_[0].impacts().size() + halves_[1].impacts().size();
    }
    /// A blow runs along a row of touching bodies whichever way it lies.
    void sweepThereAndBack()
    {
        inHalves([](ImpactVisits& visits, std::span<const std::size_t> pairs) {
            for (const std::size_t i : pairs) visits.visit(i);
        });
        const std::span<const std::size_t> across = parts_[2];
        for (const std::size_t i : across) whole_.visit(i);
        for (std::size_t p = across.size(); p-- > 0;) whole_.visit(across[p]);
        inHalves([](ImpactVisits& visits, std::span<const std::size_t> pairs) {
            for (std::size_t p = pairs.size(); p-- > 0;) visits.visit(pairs[p]);
        });
    }

    template <class Work>
    void inHalves(const Work& work)
    {
        if (!isCut_) {
            work(whole_, parts_[0]);
            return;
        }
        const std::int64_t now = whole_.clock();
        forEach(2, 1, [&](std::size_t half) {
            halves_[half].setClock(now);
            work(halves_[half], parts_[half]);
        });
        whole_.setClock(std::max(halves_[0].clock(), halves_[1].clock()));
        for (int half = 0; half < 2; ++half) {
            for (const std::size_t i : halves_[half].takeLeft()) whole_.visit(i);
        }
    }

    ImpactState& state_;
    ImpactVisits whole_{state_, ImpactVisits::Of::all};
    std::array<ImpactVisits, 2> halves_{
        {{state_, ImpactVisits::Of::half}, {state_, ImpactVisits::Of::half}}};
    std::vector<std::size_t> roomForParts_;
    PairParts parts_;
    bool isCut_ = false, isOver_ = false;
};

/// The pairs that are going to be hit, island by island, the first first. Most are hit by nothing
/// yet: they are done until a blow comes to one of their bodies.
std::vector<PairToHit> inOrderOfTime(ImpactState& state)
{
    const GapScratch& scratch = state.scratch;
    const ImpactVisits visits(state, ImpactVisits::Of::all);
    std::vector<std::optional<FirstHit>> firstHits(state.block.pairs.size());
    forPairs(state.block, [&](std::size_t p) {
        const std::size_t place = scratch.pairs[p].place;
        firstHits[place] = visits.firstHitOf(scratch.pairs[p]);
        if (!firstHits[place]) state.doneAt[place] = kBeforeAll;
    });
    std::vector<PairToHit> toHit;
    for (const std::size_t island : state.block.islands) {
        const auto begin = static_cast<std::ptrdiff_t>(toHit.size());
        for (const std::size_t p : scratch.islands[island].pairs) {
            if (const auto& first = firstHits[scratch.pairs[p].place]) toHit.push_back({p, *first});
        }
        std::ranges::stable_sort(toHit.begin() + begin, toHit.end(), {},
                                 [](const PairToHit& next) { return next.first.time; });
    }
    return toHit;
}

}  // namespace

void resolveImpacts(const StepSettings& settings, double dt, const std::vector<Held>& held,
                    GapBlock& block, GapScratch& scratch)
{
    if (settings.collisionIterations == 0) return;
    ImpactState state(settings, dt, held, block, scratch);
    const std::vector<PairToHit> toHit = inOrderOfTime(state);
    if (toHit.empty()) return;
    state.findPairsOfBodies();
    struct Outcome {
        std::vector<GapImpact> impacts;
        bool isOver = true;
    };
    const std::size_t firstIsland = block.islands.front();
    std::vector<Outcome> outcomes(block.islands.back() + 1 - firstIsland);
    forIslands(scratch, block, [&](std::size_t i) {
        const auto ofIsland = std::ranges::equal_range(
            toHit, i, {}, [&](const PairToHit& next) { return scratch.pairs[next.pair].island; });
        if (ofIsland.empty()) return;
        IslandImpacts island(state, scratch.islands[i], ofIsland.size() >= kHitsWorthACut);
        island.run(ofIsland);
        outcomes[i - firstIsland] = {island.takeImpacts(), island.isOver()};
    });
    for (const Outcome& outcome : outcomes) {
        block.impacts.insert(block.impacts.end(), outcome.impacts.begin(), outcome.impacts.end());
        block.isAtItsCap = block.isAtItsCap || !outcome.isOver;
    }
}

}  // namespace scree
