// What the passes of one step of method `scree` share and reuse from step to step: who is near
// whom, the pairs with contacts and the islands they make, and their rows. Derived but for what
// near pairs know from step to step; that is sought anew after every fourth (gap_lag.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/fetch.h"
#include "core/base/parallel.h"
#include "core/collision/broad_phase.h"
#include "core/collision/near_features.h"
#include "core/dynamics/body_pairs.h"
#include "core/dynamics/forces.h"
#include "core/dynamics/friction.h"
#include "core/dynamics/gaps/gap_rows.h"

namespace scree {

/// How far apart a pair was found to be, and how it stood then.
struct SeenApart {
    double distance = 0.0;        ///< at least [m]
    Vec3 between = Vec3::Zero();  ///< from B to A [m]
    double turned = 0.0;          ///< sum of both their GapScratch::turned [m]
};

/// Two bodies that may meet in a step, and what they remember. Small: every step lays them out
/// anew.
struct NearPair {
    BodyPair bodies;
    NearFeatures features;
    std::vector<GapContact> contacts;
    double foundWithin = -1.0;  ///< the reach of these [m]; negative: they are not known
    SeenApart seen;             ///< when contacts were last sought
    double depth = 0.0;         ///< of its deepest overlap, as last seen [m]
    bool isLagged = false;      ///< the contacts have gone along with the bodies since
    int soughtIn = 0;           ///< the last attempt at a step for which contacts were sought
};

/// The few of these that have rows.
struct GapPair {
    BodyPair bodies;
    std::size_t nearPair;                 ///< index into GapScratch::nearPairs
    std::size_t begin = 0, end = 0;       ///< its rows
    std::size_t bearing = 0;              ///< how many of them have an impulse, once solved
    bool isCarried = false;               ///< it had an impulse in the last step
    double fallOnB = 0.0, fallOnA = 0.0;  ///< share of its fall that takes the other into it
    std::size_t island = 0;               ///< index into GapScratch::islands
    int part = 0;                         ///< of a large island: of which half, 2: it joins both
    bool isLetPass = false;               ///< by gap_foresight.h, although rows would stop it
    std::size_t place = 0;                ///< in the pairs of its block

    std::size_t rowCount() const { return end - begin; }
};

/// An impact as it was answered: a blow on a row.
struct GapImpact {
    std::size_t row;
    Vec3 impulse;  ///< on A, world [N s]
    Vec3 slid;     ///< what its lever arms have allowed for [m]
    FrictionCase kind;
    Vec3 central;  ///< the part of it that goes through the centres of balls [N s]
};

/// Rows that share bodies, directly or through others: a problem of its own. Islands share no
/// movable body, so they may be solved at once and stop on their own.
struct GapIsland {
    std::vector<std::size_t> pairs;  ///< bottom to top
    std::vector<BodyId> movers;      ///< those of its bodies that can be moved, sorted
    std::size_t rowCount = 0;
    bool isRemembered = false;  ///< some of its pairs carried in the last step
    bool isKept = false;        ///< as an earlier attempt at the step has solved it
};

/// What accelerates a body beside what pulls it: gap_held.h.
struct Held {
    Vec3 acceleration = Vec3::Zero(), turning = Vec3::Zero();  ///< [m/s²], [rad/s²]
};

/// The part of a pair in it.
struct HeldByPair {
    Vec3 impulse = Vec3::Zero();                          ///< on A [N s]
    Vec3 turnOfA = Vec3::Zero(), turnOfB = Vec3::Zero();  ///< [kg m²/s]
};

/// Islands that are solved in one go.
struct GapBlock {
    std::vector<std::size_t> islands;  ///< indices into GapScratch::islands
    std::vector<std::size_t> pairs;    ///< all of theirs, sorted
    std::vector<BodyId> bodies;        ///< those of these that can be moved
    std::size_t rowCount = 0;
    std::vector<HeldByPair> heldByPairs;  ///< by their places
    std::vector<Held> held;               ///< by the places of bodies, from 1
    std::vector<GapImpact> impacts;
    bool isAtItsCap = false;  ///< impacts were left when their loops ended
};

/// Per body, of the graph of who rests on whom: contact_graph.h.
struct GapLevels {
    std::vector<int> level;
    std::vector<char> isSupported;
};

/// What of a body's motion may close gaps within a step.
struct GapPace {
    double speed = 0.0;   ///< of its centre [m/s]
    double bySpin = 0.0;  ///< of its surface about the centre, at the end of the step [m/s]
    double pull = 0.0;    ///< [m/s²]

    /// Of any point of the body, within dt.
    double fastest(double dt) const { return speed + bySpin + dt * pull; }
};

/// How a body has moved in a step.
struct BodyMove {
    Mat3 turn = Mat3::Identity();
    Vec3 shift = Vec3::Zero();  ///< of its centre of mass [m]
    double way = 0.0;           ///< of any of its points, at most [m]
    bool hasMoved = false;      ///< by as little as a bit
};

/// Whom a step, as solved, takes where it has not looked: gap_unseen.h. Per body.
struct GapUnseen {
    std::vector<double> change;      ///< of the velocity it was looked for with [m/s]
    std::vector<double> strays;      ///< how far that takes any point of it, at most [m]
    std::vector<char> isFaster;      ///< leaves the box that it was looked for in
    std::vector<Aabb> boxes;         ///< that nobody leaves
    std::vector<char> isMet;         ///< per pair that was asked about
    std::vector<BodyPair> pairs;     ///< that run visibly into each other
    std::vector<BodyPair> diverted;  ///< let pass, and met: sorted, of all attempts at this step
};

struct GapScratch {
    BroadPhase broadPhase;
    std::vector<Aabb> boxes;
    std::vector<AppliedForce> forces;
    std::vector<NearPair> nearPairs;        ///< sorted by bodies
    std::vector<NearPair> formerNearPairs;  ///< of the last step, without those that are left
    /// Per body: where it is, how it has come there in the last step, and how far turns have moved
    /// its points about its centre in all at most [m].
    std::vector<Pose> seenAt;
    std::vector<BodyMove> moves;
    std::vector<double> turned;
    /// Per body: the pace with which this step looks for gaps, what an earlier attempt has shown it
    /// to gain besides [m/s], and whether it looks for all the speed it has in common with others.
    std::vector<GapPace> paces;
    std::vector<double> gain;
    std::vector<char> looksFar;
    std::vector<char> hasNews;       ///< per body: this step has not yet found all that is near it
    std::vector<std::size_t> toAsk;  ///< the near pairs that this look is about
    GapUnseen unseen;
    int attempt = 0;  ///< at a step, of all
    std::vector<GapBody> bodies;
    std::vector<GapPair> pairs;      ///< sorted by bodies
    std::vector<GapRow> rows;        ///< of each pair together; what is between them bears nothing
    std::size_t rowCount = 0;        ///< of the pairs
    std::vector<std::size_t> order;  ///< of the pairs: island by island, bottom to top
    std::vector<GapIsland> islands;
    std::vector<std::size_t> openIslands;    ///< those that are not kept
    std::size_t openRowCount = 0;            ///< of these
    std::vector<char> isSolvedAnew;          ///< per body: since gap_unseen.h has last looked
    std::vector<GapBlock> blocks;            ///< of the islands that are not kept, in their order
    std::vector<std::int32_t> placeInBlock;  ///< per body: in the bodies of its block, from 1; or 0
    GapLevels levels;
    std::vector<GapImpact> impacts;                 ///< of this step
    std::vector<RememberedContact> formerContacts;  ///< room for what the world will remember

    const std::vector<GapContact>& contactsOf(const GapPair& pair) const
    {
        return nearPairs[pair.nearPair].contacts;
    }
    std::span<GapRow> rowsOf(const GapPair& pair)
    {
        return std::span(rows).subspan(pair.begin, pair.rowCount());
    }
    std::span<const GapRow> rowsOf(const GapPair& pair) const
    {
        return std::span(rows).subspan(pair.begin, pair.rowCount());
    }
};

/// Calls work(i) for every pair, shared by threads: it may write to what belongs to that pair
/// alone, its rows among that.
template <class Work>
void forPairs(const GapScratch& scratch, const Work& work)
{
    forEach(scratch.pairs.size(), kShortWork, work);
}

/// The same for those of a block.
template <class Work>
void forPairs(const GapBlock& block, const Work& work)
{
    forEach(block.pairs.size(), kShortWork, [&](std::size_t i) { work(block.pairs[i]); });
}

/// Calls work(index) for the islands that are told, of so many rows in all; they share no movable
/// body. What is most of all rows by itself may share its loops with all threads, the others are
/// worked on at once, each by one.
template <class Work>
void forIslands(const GapScratch& scratch, std::span<const std::size_t> islands,
                std::size_t rowCount, const Work& work)
{
    const auto isMost = [&](std::size_t i) { return 2 * scratch.islands[i].rowCount >= rowCount; };
    for (const std::size_t i : islands) {
        if (isMost(i)) work(i);
    }
    forEach(islands.size(), 1, [&](std::size_t n) {
        if (!isMost(islands[n])) work(islands[n]);
    });
}

template <class Work>
void forIslands(const GapScratch& scratch, const GapBlock& block, const Work& work)
{
    forIslands(scratch, block.islands, block.rowCount, work);
}

/// Calls visit(r) for the rows of some pairs, one after the other.
template <class Visit>
void forRows(const GapScratch& scratch, std::span<const std::size_t> pairs, const Visit& visit)
{
    for (const std::size_t i : pairs) {
        for (std::size_t r = scratch.pairs[i].begin; r < scratch.pairs[i].end; ++r) visit(r);
    }
}

/// How many pairs ahead loops over them fetch. Only time depends on it.
inline constexpr std::size_t kPairsAhead = 4;

/// Fetches the contacts of a pair that follows the i-th soon, for loops that read them; and before,
/// of one that follows later, where these are.
inline void fetchContactsAfter(const GapScratch& scratch, std::size_t i)
{
    if (i + 2 * kPairsAhead >= scratch.pairs.size()) return;
    const NearPair* later = &scratch.nearPairs[scratch.pairs[i + 2 * kPairsAhead].nearPair];
    fetchLines(later, later + 1);
    fetchItems(scratch.contactsOf(scratch.pairs[i + kPairsAhead]));
}

/// Fetches a pair's rows, and what its bodies are.
inline void fetchRows(const World& world, const GapScratch& scratch, const GapPair& pair)
{
    for (const BodyId id : {pair.bodies.a, pair.bodies.b}) {
        fetchLines(&scratch.bodies[id], &scratch.bodies[id].torque);
        fetchLines(&world.motion[id], &world.motion[id] + 1);
    }
    const GapRow* rows = scratch.rows.data();
    fetchLines(rows + pair.begin, rows + pair.end);
}

}  // namespace scree
