// Contacts are found anew after every move: a push by a tenth of a body changes which of its
// features face the other.
//
// Departs from A52. The rows of a level are solved together: one pair after the other, the first to
// be pushed decides where all the others go. And all levels take a fraction before any takes the
// next: with the lowest finished first, what lies on it was for a while as deep in it as the whole
// column had to rise, and deep inside a body hardly a feature tells the way out. And what is only
// in the way of others gives way no farther than until it is not deep: the rest is left to steps.
// In a row of fallen dominoes each had handed on a little more than it was given, by its lever, and
// a quarter of a millimetre at one end was metres at the other.
#include "core/dynamics/gaps/gap_push_deep.h"

#include <algorithm>

#include "core/dynamics/gaps/gap_levels.h"

namespace scree {
namespace {

/// Deeper than this share of the smaller body is deep, and deeper than the other goes at once as a
/// whole; between the two more and more of it, since nothing may jump at a border.
constexpr double kDeep = 0.01, kWhollyDeep = 0.0125;
/// Contacts of gaps beyond this share of the smaller body wait for the next fraction. Where spheres
/// of 5000 triangles are crushed, a look as far as the deepest overlap is long took 0.2 s a pair.
constexpr double kFarthestLook = 0.1;
/// Pushes are solved to this share of the deepest, if these sweeps do.
constexpr double kEnough = 1e-9;
constexpr int kMostSweeps = 100;
/// What is squeezed between two that do not move cannot obey both, and a wedge would throw it: so
/// no row moves its bodies farther than about three times its depth.
constexpr double kGive = 0.05;
/// No body goes farther in a round than this share of how far its contacts are looked for: of two
/// that approach each other each may go half of that unseen. What hangs together goes slower as a
/// whole, and then there are more rounds. The top of a column has to rise by all that is below it,
/// and was thrown into what nobody had looked at.
constexpr double kFarthest = 0.5;
constexpr int kMostRounds = 16;
/// All that is for what is less deep than this share of the smaller body: what is deeper may have
/// to go through where it is deeper still, as a copy does that nobody has moved away.
constexpr double kSlight = 0.2;
/// Further rounds must leave less than this share of what was deepest: what a script squeezes
/// stays.
constexpr double kGainsOn = 0.98;

}  // namespace

DeepPass::DeepPass(World& world, const StepSettings& settings, GapScratch& scratch)
    : world_(world), settings_(settings), scratch_(scratch)
{
}

PushOutTally DeepPass::run()
{
    findDeepPairs();
    if (reach_ == 0.0) return {};
    isPushed_.assign(scratch_.bodies.size(), 0);
    const std::vector<std::vector<std::size_t>> levels = pairsByLevel();
    const double first = lookAgain();
    const int rounds = settings_.pushOutLevelIterations;
    bool isHeldBack = false;
    for (int n = 1; n <= rounds; ++n)
        isHeldBack = pushRound(levels, static_cast<double>(n) / rounds);
    double last = lookAgain(), lastButOne = first;
    for (int n = rounds; isHeldBack && n < kMostRounds && last < kGainsOn * lastButOne; ++n) {
        isHeldBack = pushRound(levels, 1.0);
        lastButOne = last;
        last = lookAgain();
    }
    return tally_;
}

/// Draws apart so much of what is left. Answers whether anything was held back.
bool DeepPass::pushRound(const std::vector<std::vector<std::size_t>>& levels, double fraction)
{
    bodies_.assign(scratch_.bodies.size(), {});
    for (const std::vector<std::size_t>& level : levels) pushLevel(level, fraction);
    return displaceAll();
}

std::vector<std::vector<std::size_t>> DeepPass::pairsByLevel() const
{
    std::vector<std::vector<std::size_t>> byLevel;
    for (std::size_t i = 0; i < scratch_.nearPairs.size(); ++i) {
        const auto level =
            static_cast<std::size_t>(levelOf(scratch_.levels, scratch_.nearPairs[i].bodies));
        if (byLevel.size() <= level) byLevel.resize(level + 1);
        byLevel[level].push_back(i);
    }
    return byLevel;
}

bool DeepPass::isDeep(BodyPair pair, double depth) const
{
    return depth > kDeep * smallerRadius(world_, pair.a, pair.b);
}

/// As far as the rows tell, at the beginning of the step and at its end: a feature that was deep at
/// one of them only is one that faced the other for a moment.
void DeepPass::findDeepPairs()
{
    for (const GapPair& pair : scratch_.pairs) {
        if (!isDeep(pair.bodies, scratch_.nearPairs[pair.nearPair].depth)) continue;
        double deepest = 0.0;
        for (const GapRow& row : scratch_.rowsOf(pair)) {
            if (!isDeep(pair.bodies, -row.gap)) continue;
            const double opened = shiftAt(row, scratch_.bodies[row.a], scratch_.bodies[row.b]);
            const double depth = -row.gap - std::max(opened, 0.0);
            if (!isDeep(pair.bodies, depth) || (!row.movesA && !row.movesB)) continue;
            isLookedAt_.resize(scratch_.nearPairs.size(), 0);
            isLookedAt_[pair.nearPair] = 1;
            reach_ = std::max(reach_, depth);
            deepest = std::max(deepest, depth);
        }
        if (deepest == 0.0) continue;
        left_.resize(scratch_.nearPairs.size(), kDeep);
        const double share = deepest / smallerRadius(world_, pair.bodies.a, pair.bodies.b);
        left_[pair.nearPair] =
            std::clamp(kDeep * (kWhollyDeep - share) / (kWhollyDeep - kDeep), kSlop, kDeep);
    }
}

/// One push of all that overlaps on a level, over what those below it have been pushed.
void DeepPass::pushLevel(const std::vector<std::size_t>& level, double fraction)
{
    rows_.clear();
    for (const std::size_t i : level) addRows(i);
    pushes_.clear();
    for (const auto& [row, left] : rows_) {
        const double excess = excessOf(world_, row, row.gap, left);
        for (const auto& [id, moves] : {std::pair{row.a, row.movesA}, {row.b, row.movesB}}) {
            if (moves) takeUp(scratch_.bodies[id], 1.0, bodies_[id]);
        }
        pushes_.push_back(pushRow(row, excess > 0.0 ? fraction * excess : excess, bodies_));
        tally_.pushes += excess > 0.0;
    }
    for (int n = 0; n < kMostSweeps; ++n) {
        if (sweep(pushes_, kGive, bodies_) <= kEnough * reach_) break;
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) isPushed_[i] |= bodies_[i].isPushed;
}

/// Of what is deep, and of what the pass has moved: it may have been moved into another.
void DeepPass::addRows(std::size_t i)
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
    const Vec3 bFromA = world_.motion[a].position - world_.motion[b].position;
    for (const GapContact& contact : contacts_) {
        GapRow row{};
        placeRow(pair.bodies, contact, bFromA, row);
        row.isUnmovedA = isUnmovedBy(world_, a, b) || isFrozen(a, level);
        row.isUnmovedB = isUnmovedBy(world_, b, a) || isFrozen(b, level);
        prepareRow(scratch_.bodies, row);
        if (row.movesA || row.movesB) rows_.push_back({row, left_[i]});
    }
}

bool DeepPass::isFrozen(BodyId body, int level) const
{
    return scratch_.levels.isSupported[body] && scratch_.levels.level[body] < level;
}

/// Of the smaller body.
double DeepPass::depthShare(const NearPair& pair) const
{
    return pair.depth / smallerRadius(world_, pair.bodies.a, pair.bodies.b);
}

/// Fills contacts_ where the bodies are now; answers the depth of the deepest.
double DeepPass::look(NearPair& pair, double reach)
{
    contacts_.clear();
    pair.features.findContacts(placePair(world_, pair.bodies), reach, contacts_);
    return deepestOf(contacts_);
}

/// Of bodies that hang together. Answers whether they wanted to go farther.
bool DeepPass::holdBack(std::span<const BodyId> bodies)
{
    double share = 1.0;
    for (const BodyId body : bodies) {
        const PushedBody& pushed = bodies_[body];
        const double radius = world_.shapeOf(body).boundingRadius;
        const double way = std::max(pushed.shift.norm(), pushed.turn.norm() * radius);
        const double farthest = kFarthest * std::min(reach_, kFarthestLook * radius);
        if (way > farthest) share = std::min(share, farthest / way);
    }
    if (share == 1.0) return false;
    for (const BodyId body : bodies) {
        bodies_[body].shift *= share;
        bodies_[body].turn *= share;
    }
    return true;
}

bool DeepPass::displaceAll()
{
    bool isHeldBack = false;
    std::vector<char> isOfIsland(bodies_.size(), 0);
    for (const GapIsland& island : scratch_.islands) {
        for (const BodyId body : island.movers) isOfIsland[body] = 1;
        const bool isSlight = std::ranges::all_of(island.pairs, [&](std::size_t i) {
            return depthShare(scratch_.nearPairs[scratch_.pairs[i].nearPair]) < kSlight;
        });
        if (isSlight) isHeldBack = holdBack(island.movers) || isHeldBack;
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const auto body = static_cast<BodyId>(i);
        if (!bodies_[i].isPushed) continue;
        if (!isOfIsland[i]) isHeldBack = holdBack({&body, 1}) || isHeldBack;  // had no contact yet
        tally_.cut += displace(world_, body, bodies_[i]);
    }
    return isHeldBack;
}

/// At what has been looked at or moved. Answers the deepest, as a share of the smaller body.
double DeepPass::lookAgain()
{
    double deepest = 0.0;
    for (std::size_t i = 0; i < scratch_.nearPairs.size(); ++i) {
        NearPair& pair = scratch_.nearPairs[i];
        const auto [a, b] = pair.bodies;
        if (!isLookedAt_[i] && !isPushed_[a] && !isPushed_[b]) continue;
        isLookedAt_[i] = 1;
        pair.depth = look(pair, 0.0);
        deepest = std::max(deepest, depthShare(pair));
    }
    return deepest;
}

}  // namespace scree
