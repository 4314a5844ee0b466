// Impulses are accumulated and clamped as totals, not one by one: a row may give back what turned
// out to be too much, and the sweeps have a fixed point. They start from what held the heap in the
// last step; a heap at rest is at the fixed point already.
//
// What was tried on a stack of 40 cubes at one step a frame: plain projected Gauss–Seidel falls
// with 200 sweeps; with conjugate directions it drifts 9 mm with 100; begun from the weights handed
// down level by level, 0.4 mm with 370. A block that lies on one ten thousand times lighter needs
// shock besides.
//
// On walls and heaps of rings: impulses that begin with what they changed by in the last step too,
// as far as that takes energy away, saved a wall that sways a quarter of its time, and of a
// thousand rings 434 instead of 272 were awake after 10 s. Sweeps until nothing closes by more than
// a thousandth of a body in the step take a blow through the whole wall, and a part of it falls.
#include "core/dynamics/gaps/gap_contact.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/base/parallel.h"
#include "core/dynamics/gaps/gap_forces.h"
#include "core/dynamics/gaps/gap_lanes.h"
#include "core/dynamics/gaps/gap_levels.h"
#include "core/dynamics/gaps/gap_press.h"
#include "core/dynamics/gaps/gap_shock.h"
#include "core/dynamics/gaps/gap_visit.h"
#include "core/dynamics/gaps/stillness.h"

namespace scree {
namespace {

/// A small problem is solved to the end, a large one gets the sweeps of the settings. Between them
/// sweeps fall with the square of the rows: a tower of forty cubes, 160 rows, gets 370, a heap of
/// 1000 rows no more than the settings say.
constexpr std::size_t kSpareVisits = 60000, kSpareRows = 160;
constexpr int kMostSweeps = 400;

/// In a chain or a column what happens at one end has to come through all levels, one by one: so
/// many sweeps for each. Of sixty links that swing shock did the rest, with the upper ones pinned
/// as they moved, and that was work: 1.7 kJ in 20 s, more than they could fall; 36 J so. A heap has
/// many pairs on each level, and its ways are short.
constexpr int kSweepsPerLevel = 4, kLevelsOfAChain = 8;
constexpr int kPairsPerLevel = 2;  // at most, of a chain

/// A large heap gets as many once it settles. It begins with what held it in the last step, so that
/// a dozen do while it moves; but they leave it to creep, and of 150 coins in a bowl, forty levels,
/// half went on doing so for as long as anybody looked. It costs little: it is soon asleep. So is
/// what should have settled long ago, as a chimney with a hole in its foot that crept until it
/// fell.
constexpr int kSweepsToRest = 100;

/// What hardly moves, slipping when sweeps begin by less than kAtRest of what gravity does in a
/// step, gets more: what is left wrong there sets it going, and it sags until it is another thing.
/// A heap gets as many as if it settled: of 84 random walls with openings twelve leaned out by one
/// to seven millimetres before they slept, and now two by less than two. A smaller problem gets
/// kTimesAtRest as many, also where it is new: of 60 random arches of up to sixty stones that stand
/// by statics, with a twentieth of their thickness and friction to spare, eight sank or fell with
/// 400 sweeps; now 133 of 133 stand. They cost a tenth, for they sleep at once, and what tumbles
/// pays nothing.
constexpr std::size_t kTimesAtRest = 40, kMostSweepsAtRest = 4000;
constexpr double kAtRest = 0.3;

/// A new heap gets as many, until they change less than this share of what gravity does in a step.
/// Walls stood as well with fewer, but for pieces that lie across each other the weight handed down
/// is no guess: what a dozen sweeps left of it burst a column of 160 that fit in the first frame,
/// with 734 J that nobody had paid.
constexpr double kLeftInANewHeap = 1e-2;

/// Impulses that are too large work: they part what they should hold, and friction drives what it
/// should brake. Beside the energy that contacts take from the motion of a heap of rings or cubes
/// that is a twentieth after the sweeps of the settings, and does not show. A wall of bricks that
/// rocks by a finger's breadth is left with two thirds, and step after step that becomes motion:
/// one of 840 with a hole in it rocked wider and wider, and half of it fell after four seconds.
/// Where more than a tenth is wrong sweeps go on until half of that is, and the wall sleeps within
/// eight seconds. When little moves that would take forever: what is wrong may be so small a share
/// of what gravity has set about. With three times that one of three such walls falls.
constexpr double kMuchIsWrong = 0.1, kLittleIsWrong = 0.05, kWrongInVain = 0.005;
constexpr int kSweepsBetweenLooks = 10;

/// So many sweeps in a unit of time (stillness.h) at most, for what is wrong: what takes many is
/// how a whole wall sways, and that takes its time, in however many steps, each of which goes on
/// with what the one before has found. With four hundred in each a wall that is being shot through,
/// seventeen steps a frame, takes twice the time, and stands no better; with two thirds of these
/// one of a dozen falls.
constexpr double kSweepsPerUnit = 2400.0;

/// What a sweep may still change, as a share of what gravity does in a step, or, where rows are
/// many, of what the first sweep changed. Forty cubes of which each step left a hundredth drifted
/// 15 mm in 10 s. With a tenth of kEnough coins that a pusher carries to and fro take 1.2 times as
/// long, and no stack stands better.
constexpr double kEnough = 1e-5, kLeftToNextStep = 1e-3, kLeftInAHeap = 1e-2, kLeftInAChain = 1e-4;
constexpr std::size_t kFewRows = 32, kRowsOfAHeap = 200;

/// The same, as a share of the fastest slip when sweeps begin: what tumbles or slides by a metre a
/// second is not seen to do so a tenth of a millimetre off. A hundred rings need six tenths of the
/// sweeps of an exact solution; most of those saved circled to their cap and came to no end. So did
/// columns of cubes that collapse in a bin, which count as chains: without this contacts took 1.4
/// times as long. With three times as much they take four fifths, but in seven heaps of rings the
/// deepest lay 0.5 mm in the floor, not 0.2 to 0.3. Of a body or two the exact solution costs
/// nothing; a heap has its own limits, and one ring that rolls past must not make it creep.
constexpr double kShareOfSpeed = 1e-4;
constexpr std::size_t kRowsOfABodyOrTwo = 8;

/// Where constraints contradict each other by a ten thousandth of what gravity does in a step, as
/// those of links pulled taut do and of coins that lean on a rim, sweeps come to no end, and
/// impulses grow: what is below kNowhere of that and has not shrunk to kShrinks in kSpan sweeps is
/// as far as it gets. Of the visits that a swinging chain needed a fifth went there, of those for
/// coins on a tray that shakes a half.
constexpr int kSpan = 32;
constexpr double kNowhere = 1e-3, kShrinks = 0.7;

/// Two hundred columns of fifteen crates came to no end a good way above: each took its 400 sweeps
/// as it tumbled, and 4000 where it hardly moved, five seconds a frame. What goes on as it did gets
/// no farther either when it is below kNowhereOfSpeed of the fastest slip and tumbles, or below
/// kNowhereForLong and has been for kLongSpan sweeps. What is new needs them: with this the first
/// step of an arch left it to fall. So does what has few rows: of a slab on rollers that brake
/// a twentieth of the way was lost.
constexpr int kLongSpan = 256;
constexpr double kNowhereOfSpeed = 1e-2, kNowhereForLong = 1e-2;

/// The share of a heap's last way. Somewhere in it rows always begin or cease to carry, and who
/// begins anew for each of them does without conjugate directions: every third or fourth sweep did.
/// Nine tenths and more without that run away. For as little wrong work the wall needs two thirds
/// of the sweeps so.
constexpr double kMostOfTheWay = 0.8, kRunsAway = 1.3;

double shareInAHeap(double energy, double energyBefore)
{
    const double share = shareOfLastWay(energy, energyBefore);
    return share > kRunsAway ? share : std::min(share, kMostOfTheWay);
}

int spareSweeps(const GapIsland& island, std::size_t times = 1, std::size_t most = kMostSweeps)
{
    const std::size_t rows = island.rowCount + 1;
    return static_cast<int>(std::min(times * kSpareVisits * kSpareRows / (rows * rows), most));
}

/// Whether sweeps go nowhere any more.
class Progress {
public:
    Progress(double speedOfFall, bool isNew)
        : short_{kSpan, kNowhere * speedOfFall},
          long_{kLongSpan, isNew ? 0.0 : kNowhereForLong * speedOfFall}
    {
    }

    /// Of what tumbles, by its fastest slip [m/s].
    void tumbles(double fastest)
    {
        short_.nowhere = std::max(short_.nowhere, kNowhereOfSpeed * fastest);
    }

    bool hasEnded(double residual)
    {
        ++sweeps_;
        const bool inShort = short_.hasEnded(residual, sweeps_);
        return long_.hasEnded(residual, sweeps_) || inShort;
    }

private:
    struct Span {
        int sweeps;
        double nowhere;  // [m/s]
        double least = std::numeric_limits<double>::infinity(), leastBefore = least;

        bool hasEnded(double residual, int done)
        {
            least = std::min(least, residual);
            if (done % sweeps != 0) return false;
            const bool ended = least <= nowhere && least > kShrinks * leastBefore;
            leastBefore = std::exchange(least, std::numeric_limits<double>::infinity());
            return ended;
        }
    };
    Span short_, long_;
    int sweeps_ = 0;
};

/// What a step may spend on an island: the sweeps of the settings on a large heap, more on a small
/// problem and in a chain.
struct SweepLimits {
    int most;
    int mostAtRest;  // where it hardly moves
    double left;     // share of the change of the first sweep that may be left to the next step
    double ofSpeed;  // the same of the fastest slip
};

SweepLimits sweepLimits(const World& world, const StepSettings& settings, const GapScratch& scratch,
                        const GapIsland& island)
{
    int levels = 0;
    for (const std::size_t i : island.pairs)
        levels = std::max(levels, levelOf(scratch.levels, scratch.pairs[i].bodies) + 1);
    int most = std::max(settings.gapSweeps, spareSweeps(island));
    if (most < kSweepsToRest && isSettling(world, scratch, island)) most = kSweepsToRest;
    const int mostAtRest =
        isHeap(island) ? kSweepsToRest : spareSweeps(island, kTimesAtRest, kMostSweepsAtRest);
    if (levels >= kLevelsOfAChain && std::ssize(island.pairs) <= kPairsPerLevel * levels)
        return {std::max(most, kSweepsPerLevel * levels), mostAtRest, kLeftInAChain, kShareOfSpeed};
    const double left = island.rowCount > kRowsOfAHeap ? kLeftInAHeap
                        : island.rowCount > kFewRows   ? kLeftToNextStep
                                                       : 0.0;
    const bool mayTumble = island.rowCount > kRowsOfABodyOrTwo && island.rowCount <= kRowsOfAHeap;
    return {most, mostAtRest, left, mayTumble ? kShareOfSpeed : 0.0};
}

/// The most sweeps of an island in a step of which much is wrong. None where the bodies feel their
/// first impulses before these are built, as those of what remembers nothing do.
int sweepsWhileWrong(const World& world, double dt, const GapScratch& scratch,
                     const GapIsland& island)
{
    if (!island.isRemembered) return 0;
    double units = 0.0;
    for (const BodyId body : island.movers)
        units += dt / unitOfTime(world, body, scratch.bodies[body].pull.norm());
    const double ofEach = units / static_cast<double>(island.movers.size());
    return static_cast<int>(std::min<double>(kSweepsPerUnit * ofEach, kMostSweeps));
}

/// Until a sweep changes next to nothing beside gravity or the first one: the rest is left to the
/// next step, which begins with what this one found.
void solve(const World& world, const StepSettings& settings, double dt, const GapScratch& scratch,
           const GapIsland& island, GapLanes& rows)
{
    const double speedOfFall = strongestPull(scratch, island) * dt;
    const double least = std::max(kEnough * speedOfFall, roundingOfSpeeds(world, island, dt));
    double enough = least;
    auto [most, mostAtRest, left, ofSpeed] = sweepLimits(world, settings, scratch, island);
    // What is new begins with the weight handed down, which its bodies feel already.
    if (island.isRemembered) rows.begin();
    const auto shareOfWay = isHeap(island) ? shareInAHeap : shareOfLastWay;
    Progress progress(speedOfFall, !island.isRemembered);
    double energy = 0.0, mayBeWrong = kMuchIsWrong;
    for (int done = 1;; ++done) {
        const GapSweep swept = rows.sweep();
        if (done == 1) {
            enough = std::max({enough, left * swept.residual, ofSpeed * swept.fastest});
            const bool isNewHeap = !island.isRemembered && isHeap(island) && speedOfFall > 0.0;
            if (isNewHeap) {
                enough = std::max(least, std::min(enough, kLeftInANewHeap * speedOfFall));
                most = std::max(most, static_cast<int>(kMostSweepsAtRest));
            }
            const bool isNew = !island.isRemembered && !isHeap(island);
            const bool isAtRest = swept.fastest < kAtRest * speedOfFall;
            if (isNew || isAtRest) most = std::max(most, mostAtRest);
            const bool mayTumble = ofSpeed > 0.0 && island.rowCount > kFewRows;
            if (island.isRemembered && mayTumble && !isAtRest) progress.tumbles(swept.fastest);
        }
        if (swept.residual <= enough) return;
        if (progress.hasEnded(swept.residual)) most = std::min(most, done);
        if (done >= most) {
            if (done >= sweepsWhileWrong(world, dt, scratch, island)) return;
            const GapWork work = rows.work(scratch);
            if (work.wrong <= std::max(mayBeWrong * work.taken, kWrongInVain * work.borne)) return;
            mayBeWrong = kLittleIsWrong;
            most += kSweepsBetweenLooks;
        }
        rows.goOn(shareOfWay(swept.energy, energy));
        energy = swept.energy;
    }
}

void solveIsland(const World& world, const StepSettings& settings, double dt, GapScratch& scratch,
                 const GapIsland& island)
{
    thread_local GapLanes lanes;
    lanes.build(scratch, island);
    solve(world, settings, dt, scratch, island, lanes);
    lanes.store(scratch);
    if (isPressed(dt, scratch, island)) solvePressed(dt, island, scratch);
}

}  // namespace

bool isHeap(const GapIsland& island)
{
    // Not as many as the settings say: who asks for more would lose what small problems have.
    constexpr int kSweepsOfAHeap = 12;
    return spareSweeps(island) <= kSweepsOfAHeap;
}

double roundingOfSpeeds(const World& world, const GapIsland& island, double dt)
{
    constexpr double kRoundings = 200.0;  // of the places from whose differences gaps come
    double farthest = 0.0;
    for (const BodyId body : island.movers)
        farthest = std::max(farthest, world.motion[body].position.squaredNorm());
    return kRoundings * std::numeric_limits<double>::epsilon() * std::sqrt(farthest) / dt;
}

void resolveGaps(const World& world, const StepSettings& settings, double dt, const GapBlock& block,
                 GapScratch& scratch)
{
    handWeightDown(dt, block, scratch);
    forIslands(scratch, block, [&](std::size_t i) {
        solveIsland(world, settings, dt, scratch, scratch.islands[i]);
    });
}

ImpulseCounts countImpulses(GapScratch& scratch)
{
    std::atomic<std::int64_t> sliding = 0, sticking = 0;
    parallelFor(scratch.pairs.size(), 256, [&](std::size_t begin, std::size_t end) {
        std::int64_t slide = 0, stick = 0;
        for (std::size_t i = begin; i < end; ++i) {
            GapPair& pair = scratch.pairs[i];
            pair.bearing = 0;
            for (const GapRow& row : scratch.rowsOf(pair)) {
                if (!row.carries()) continue;
                ++pair.bearing;
                ++(sticks(row) ? stick : slide);
            }
        }
        sliding += slide;
        sticking += stick;
    });
    ImpulseCounts counts;
    counts.sliding = sliding;
    counts.sticking = sticking;
    return counts;
}

}  // namespace scree
