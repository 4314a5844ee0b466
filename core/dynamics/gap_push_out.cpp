// Symbols: λ first-order impulse of a row [kg m], K its response, f fraction of the depth removed
//          now, c share by which a row gives way.
//
// Two kinds of overlap. Steps leave a thousandth of a body or so; removing that at once shook
// stacks, and a fifth of it in a step is enough. What is deeper has begun so, or is squeezed by a
// script: a fifth a step would show it coming apart for a second. That is done at once and the
// paper's way: gradually, and bottom to top, so that a column rises from the floor and nothing is
// pressed into what is already right. Contacts are found anew after every move: a push by a tenth
// of a body changes which of its features face the other.
//
// Departs from A52. The rows of a level are solved together: one pair after the other, the first to
// be pushed decides where all the others go. And all levels take a fraction before any takes the
// next: with the lowest finished first, what lies on it was for a while as deep in it as the whole
// column had to rise, and deep inside a body hardly a feature tells the way out. And what is only
// in the way of others gives way no farther than until it is not deep: the rest is left to steps.
// In a row of fallen dominoes each had handed on a little more than it was given, by its lever, and
// a quarter of a millimetre at one end was metres at the other.
#include "core/dynamics/gap_push_out.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/dynamics/gap_levels.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

/// Overlap that is left alone, as a share of the smaller body: removing all of it shook stacks.
constexpr double kSlop = 1e-4;
/// Share of the rest that one step removes, and how exactly.
constexpr double kShare = 0.2;
constexpr int kSweeps = 8;

/// Deeper than this share of the smaller body is deep, and deeper than the other goes at once as a
/// whole; between the two more and more of it, since nothing may jump at a border.
constexpr double kDeep = 0.01, kWhollyDeep = 0.0125;
/// Contacts of gaps beyond this share of the smaller body wait for the next fraction. Where spheres
/// of 5000 triangles are crushed, a look as far as the deepest overlap is long took 0.2 s a pair.
constexpr double kFarthestLook = 0.1;
/// Deep ones are solved to this share of the deepest, if these sweeps do.
constexpr double kEnough = 1e-9;
constexpr int kMostSweeps = 100;
/// What is squeezed between two that do not move cannot obey both, and a wedge would throw it: with
/// this c no row moves its bodies farther than 1/√(2c) times its depth, about three.
constexpr double kGive = 0.05;

/// What push-out adds to the place of a body. One cache line: two threads write to neighbours.
struct alignas(64) Displacement {
    Vec3 shift = Vec3::Zero(), turn = Vec3::Zero();  // [m], [rad]
};

/// Of a row what sweeps look at: less than half of it.
struct RowPush {
    BodyId a, b;
    bool movesA, movesB;
    Vec3 rA, rB, normal;
    double inverseMass;  // of its separation
    double wanted;       // separation [m]; negative: how far it may close
    double impulse = 0.0;

    RowPush(const GapRow& row, double separation)
        : a(row.a),
          b(row.b),
          movesA(row.movesA),
          movesB(row.movesB),
          rA(row.rA),
          rB(row.rB),
          normal(row.normal),
          inverseMass(row.inverseNormalMass),
          wanted(separation)
    {
    }
};

double excessOf(const World& world, const GapRow& row, double gap, double left = kSlop)
{
    return -gap - left * smallerRadius(world, row.a, row.b);
}

double separationAt(const RowPush& row, const Displacement& a, const Displacement& b)
{
    return row.normal.dot(a.shift + a.turn.cross(row.rA) - b.shift - b.turn.cross(row.rB));
}

/// One sweep over the rows; answers the largest change of a separation [m].
double sweep(const GapScratch& scratch, double give, std::vector<RowPush>& pushes,
             std::vector<Displacement>& displacements)
{
    double largest = 0.0;
    for (RowPush& row : pushes) {
        Displacement &a = displacements[row.a], &b = displacements[row.b];
        const double k = row.inverseMass;
        const double missing = row.wanted - separationAt(row, a, b) - give * k * row.impulse;
        const double impulse = std::max(0.0, row.impulse + missing / (k * (1.0 + give)));
        const Vec3 change = (impulse - row.impulse) * row.normal;
        largest = std::max(largest, k * std::abs(impulse - row.impulse));
        row.impulse = impulse;
        if (row.movesA) {
            a.shift += scratch.bodies[row.a].inverseMass * change;
            a.turn += scratch.bodies[row.a].inverseInertia * row.rA.cross(change);
        }
        if (row.movesB) {
            b.shift -= scratch.bodies[row.b].inverseMass * change;
            b.turn -= scratch.bodies[row.b].inverseInertia * row.rB.cross(change);
        }
    }
    return largest;
}

/// Answers how many bodies asked for more than a push may do.
std::int64_t displace(World& world, std::vector<Displacement>& displacements)
{
    std::int64_t cut = 0;
    for (std::size_t i = 0; i < displacements.size(); ++i) {
        Displacement& d = displacements[i];
        if (d.shift.isZero(0.0) && d.turn.isZero(0.0)) continue;
        const double share =
            admissibleShare(world.shapeOf(static_cast<BodyId>(i)), d.shift, d.turn);
        if (share < 1.0) {
            ++cut;
            d.shift *= share;
            d.turn *= share;
        }
        world.motion[i].position += d.shift;
        world.motion[i].orientation = rotated(world.motion[i].orientation, d.turn);
    }
    return cut;
}

/// Draws deep overlaps apart, level by level.
class DeepPass {
public:
    DeepPass(World& world, const StepSettings& settings, GapScratch& scratch)
        : world_(world), settings_(settings), scratch_(scratch)
    {
    }

    PushOutTally run()
    {
        findDeepPairs();
        if (reach_ == 0.0) return {};
        isPushed_.assign(scratch_.bodies.size(), 0);
        std::vector<std::vector<std::size_t>> byLevel;
        for (std::size_t i = 0; i < scratch_.nearPairs.size(); ++i) {
            const auto level =
                static_cast<std::size_t>(levelOf(scratch_.levels, scratch_.nearPairs[i].bodies));
            if (byLevel.size() <= level) byLevel.resize(level + 1);
            byLevel[level].push_back(i);
        }
        for (int n = 1; n <= settings_.pushOutLevelIterations; ++n) {
            const double fraction = static_cast<double>(n) / settings_.pushOutLevelIterations;
            displacements_.assign(scratch_.bodies.size(), {});
            for (const std::vector<std::size_t>& level : byLevel) pushLevel(level, fraction);
            tally_.cut += displace(world_, displacements_);
        }
        lookAfterwards();
        return tally_;
    }

    /// Whether the rows of a pair have been dealt with.
    bool isLookedAt(const GapPair& pair) const
    {
        return !isLookedAt_.empty() && isLookedAt_[pair.near] != 0;
    }

private:
    struct RowToPush {
        GapRow row;
        double left;  // for the steps to remove, as a share of the smaller body
    };

    bool isDeep(BodyPair pair, double depth) const
    {
        return depth > kDeep * smallerRadius(world_, pair.a, pair.b);
    }

    /// As far as the rows tell, at the beginning of the step and at its end: a feature that was
    /// deep at one of them only is one that faced the other for a moment.
    void findDeepPairs()
    {
        for (const GapPair& pair : scratch_.pairs) {
            if (!isDeep(pair.bodies, scratch_.nearPairs[pair.near].depth)) continue;
            double deepest = 0.0;
            for (std::size_t r = pair.begin; r < pair.end; ++r) {
                const GapRow& row = scratch_.rows[r];
                if (!isDeep(pair.bodies, -row.gap)) continue;
                const double opened = shiftAt(row, scratch_.bodies[row.a], scratch_.bodies[row.b]);
                const double depth = -row.gap - std::max(opened, 0.0);
                if (!isDeep(pair.bodies, depth) || (!row.movesA && !row.movesB)) continue;
                isLookedAt_.resize(scratch_.nearPairs.size(), 0);
                isLookedAt_[pair.near] = 1;
                reach_ = std::max(reach_, depth);
                deepest = std::max(deepest, depth);
            }
            if (deepest == 0.0) continue;
            left_.resize(scratch_.nearPairs.size(), kDeep);
            const double share = deepest / smallerRadius(world_, pair.bodies.a, pair.bodies.b);
            left_[pair.near] =
                std::clamp(kDeep * (kWhollyDeep - share) / (kWhollyDeep - kDeep), kSlop, kDeep);
        }
    }

    /// One push of all that overlaps on a level, over what those below it have been pushed.
    void pushLevel(const std::vector<std::size_t>& level, double fraction)
    {
        rows_.clear();
        for (const std::size_t i : level) addRows(i);
        pushes_.clear();
        for (const RowToPush& one : rows_) {
            const double excess = excessOf(world_, one.row, one.row.gap, one.left);
            pushes_.emplace_back(one.row, excess > 0.0 ? fraction * excess : excess);
            tally_.pushes += excess > 0.0;
        }
        for (int n = 0; n < kMostSweeps; ++n) {
            if (sweep(scratch_, kGive, pushes_, displacements_) <= kEnough * reach_) break;
        }
        for (std::size_t i = 0; i < displacements_.size(); ++i) {
            isPushed_[i] |= !displacements_[i].shift.isZero(0.0);
        }
    }

    /// Of what is deep, and of what the pass has moved: it may have been moved into another.
    void addRows(std::size_t i)
    {
        NearPair& pair = scratch_.nearPairs[i];
        const auto [a, b] = pair.bodies;
        const bool isMoved = isPushed_[a] || isPushed_[b];
        if (!isLookedAt_[i] && !isMoved) return;
        isLookedAt_[i] = 1;
        const double farthest = kFarthestLook * smallerRadius(world_, a, b);
        const double depth = look(pair, std::min(reach_, farthest));
        if (!isMoved && !isDeep(pair.bodies, depth)) {
            isLookedAt_[i] = 0;  // the rows had seen it deeper than it is
            return;
        }
        const int level = levelOf(scratch_.levels, pair.bodies);
        for (const GapContact& contact : contacts_) {
            GapRow row{};
            row.a = a;
            row.b = b;
            row.rA = contact.rA;
            row.rB = contact.rA + world_.motion[a].position - world_.motion[b].position;
            row.normal = contact.normal;
            row.gap = contact.gap;
            row.isUnmovedA = isUnmovedBy(world_, a, b) || isFrozen(a, level);
            row.isUnmovedB = isUnmovedBy(world_, b, a) || isFrozen(b, level);
            prepareRow(scratch_.bodies, row);
            if (row.movesA || row.movesB) rows_.push_back({row, left_[i]});
        }
    }

    bool isFrozen(BodyId body, int level) const
    {
        return scratch_.levels.isSupported[body] && scratch_.levels.level[body] < level;
    }

    /// Fills contacts_ where the bodies are now; answers the depth of the deepest.
    double look(NearPair& pair, double reach)
    {
        contacts_.clear();
        pair.near.findContacts(placePair(world_, pair.bodies), reach, contacts_);
        return deepestOf(contacts_);
    }

    void lookAfterwards()
    {
        for (std::size_t i = 0; i < scratch_.nearPairs.size(); ++i) {
            NearPair& pair = scratch_.nearPairs[i];
            if (isLookedAt_[i]) pair.depth = look(pair, 0.0);
        }
    }

    World& world_;
    const StepSettings& settings_;
    GapScratch& scratch_;
    PushOutTally tally_;
    double reach_ = 0.0;  // of contacts that pushes may close: the deepest overlap [m]
    // Most steps find nothing deep, and then these are empty.
    std::vector<char> isLookedAt_, isPushed_;  // per near pair; per body
    std::vector<double> left_;                 // per near pair: as of RowToPush
    std::vector<GapContact> contacts_;
    std::vector<RowToPush> rows_;
    std::vector<RowPush> pushes_;
    std::vector<Displacement> displacements_;
};

/// What the pass below fills, kept from step to step.
struct ShallowPushes {
    std::vector<double> wanted;                  // separation per row; 0: none [m]
    std::array<std::vector<RowPush>, 3> pushes;  // by the parts of the pairs
    std::vector<Displacement> displacements;     // per body
};

/// What steps leave: a share of it.
PushOutTally separateShallow(World& world, const DeepPass& deep, const GapScratch& scratch)
{
    thread_local ShallowPushes kept;
    auto& [wanted, pushes, displacements] = kept;  // of this thread, filled by all
    wanted.assign(scratch.rows.size(), 0.0);
    forPairs(scratch, [&](std::size_t i) {
        const GapPair& pair = scratch.pairs[i];
        if (deep.isLookedAt(pair)) return;
        for (std::size_t r = pair.begin; r < pair.end; ++r) {
            const GapRow& row = scratch.rows[r];
            const double gap = row.gap + shiftAt(row, scratch.bodies[row.a], scratch.bodies[row.b]);
            wanted[r] = kShare * std::max(excessOf(world, row, gap), 0.0);
        }
    });
    for (std::vector<RowPush>& ofPart : pushes) ofPart.clear();
    for (const std::size_t i : scratch.order) {
        const GapPair& pair = scratch.pairs[i];
        for (std::size_t r = pair.begin; r < pair.end; ++r) {
            if (wanted[r] > 0.0) pushes[pair.part].emplace_back(scratch.rows[r], wanted[r]);
        }
    }
    const std::size_t count = pushes[0].size() + pushes[1].size() + pushes[2].size();
    if (count == 0) return {};
    displacements.assign(scratch.bodies.size(), {});
    for (int n = 0; n < kSweeps; ++n) {
        forEach(pushes[1].empty() ? 1 : 2, 1,
                [&](std::size_t half) { sweep(scratch, 0.0, pushes[half], displacements); });
        sweep(scratch, 0.0, pushes[2], displacements);
    }
    return {static_cast<std::int64_t>(count), displace(world, displacements)};
}

}  // namespace

PushOutTally separateGaps(World& world, const StepSettings& settings, GapScratch& scratch)
{
    DeepPass deep(world, settings, scratch);
    PushOutTally tally = deep.run();
    tally += separateShallow(world, deep, scratch);
    return tally;
}

WorstOverlap findWorstGap(const World& world, const GapScratch& scratch)
{
    // The first of equal ones counts, however many threads there are.
    constexpr std::size_t kTogether = 1024;
    const std::vector<NearPair>& pairs = scratch.nearPairs;
    std::vector<WorstOverlap> ofParts((pairs.size() + kTogether - 1) / kTogether);
    forEach(ofParts.size(), 1, [&](std::size_t part) {
        const std::size_t end = std::min((part + 1) * kTogether, pairs.size());
        for (std::size_t i = part * kTogether; i < end; ++i)
            ofParts[part].include(world, pairs[i].bodies, pairs[i].depth);
    });
    WorstOverlap worst;
    for (const WorstOverlap& one : ofParts) worst.include(one);
    return worst;
}

}  // namespace scree
