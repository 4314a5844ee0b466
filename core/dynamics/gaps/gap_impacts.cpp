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
#include "core/dynamics/gaps/gap_impacts.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/contact_point.h"
#include "core/dynamics/friction.h"

namespace scree {
namespace {

/// How exactly places that are hit together are answered, as a share of the speed of the impact. A
/// face has few: of a crate that landed flat what was left made a spin, three times as fast after
/// each bounce, and it tumbled after the fourth.
constexpr double kPairIsSolved = 3e-4, kFaceIsSolved = 1e-10;
constexpr std::size_t kHitsOfAFace = 8;

/// What arrives by so many times what it falls in a step is stopped where it arrives, also if it
/// does not bounce. As a contact it would be stopped little by little over two steps, where it
/// turns by then: of rods that landed on an end, e = 0, the spin they got was up to two fifths off.
constexpr double kLands = 3.0;

/// Places that are hit within this share of a step are hit together.
constexpr double kTogether = 0.01;

/// Whether what hits there has come from afar in this step: it was neither hit already nor did
/// its bodies lie on each other.
bool arrives(const Impact& hit)
{
    return !hit.row->wasHit && !hit.isCarried;
}

template <class Which>
void dropHits(std::vector<Impact>& hits, std::size_t from, const Which& which)
{
    const auto begin = hits.begin() + static_cast<std::ptrdiff_t>(from);
    hits.erase(std::remove_if(begin, hits.end(), which), hits.end());
}

double strongerPull(const GapBody& a, const GapBody& b)
{
    return std::max(a.pull.norm(), b.pull.norm());
}

}  // namespace

PairsOfBodies::PairsOfBodies(const GapBlock& block, const GapScratch& scratch)
    : begin_(block.bodies.size() + 2, 0)
{
    const auto forBodies = [&](const auto& visit) {
        for (const std::size_t island : block.islands) {
            for (const std::size_t i : scratch.islands[island].pairs) {
                for (const BodyId body : {scratch.pairs[i].bodies.a, scratch.pairs[i].bodies.b}) {
                    if (const std::int32_t place = scratch.placeInBlock[body]) visit(place, i);
                }
            }
        }
    };
    forBodies([&](std::int32_t place, std::size_t) { ++begin_[place + 1]; });
    for (std::size_t b = 1; b < begin_.size(); ++b) begin_[b] += begin_[b - 1];
    pairs_.resize(begin_.back());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    forBodies([&](std::int32_t place, std::size_t i) { pairs_[next[place]++] = i; });
}

ImpactState::ImpactState(const StepSettings& stepSettings, double stepLength,
                         const std::vector<Held>& heldAsBefore, const GapBlock& ofBlock,
                         GapScratch& ofStep)
    : settings(stepSettings),
      dt(stepLength),
      slowest(slowestApproach(stepSettings, stepLength)),
      block(ofBlock),
      scratch(ofStep),
      held(heldAsBefore),
      changes(ofBlock.bodies.size() + 1),
      doneAt(ofBlock.pairs.size(), 0),
      gatheredAt(ofBlock.pairs.size(), 0)
{
}

std::optional<FirstHit> ImpactVisits::firstHitOf(const GapPair& pair) const
{
    std::optional<FirstHit> first;
    Impact impact{};
    for (std::size_t r = pair.begin; r < pair.end; ++r) {
        if (!impactOf(pair, scratch_.rows[r], impact) || impact.onlyPrecedes) continue;
        const double speed = -impact.velocity.dot(impact.row->normal);
        first = first ? FirstHit{std::min(first->time, impact.time), std::max(first->speed, speed)}
                      : FirstHit{impact.time, speed};
    }
    return first;
}

/// What lies on something does not fall on what lies a hair below it: of gravity only that
/// brings the two together which what held their bodies in the last step would let through now.
/// A ring that hung on three corners of a pole fell on a fourth 0.4 mm away, through the three,
/// and was pushed out again, step after step.
Vec3 ImpactVisits::gravityAt(const GapRow& row) const
{
    const Vec3 free = scratch_.bodies[row.a].pull - scratch_.bodies[row.b].pull;
    const double g = free.dot(row.normal);
    if (g >= 0.0) return free;
    const Held &a = state_.held[state_.placeOf(row.a)], &b = state_.held[state_.placeOf(row.b)];
    const Vec3 held =
        a.acceleration + a.turning.cross(row.rA) - b.acceleration - b.turning.cross(row.rB);
    return free + std::clamp(held.dot(row.normal), 0.0, -g) * row.normal;
}

/// False when the row is not going to be hit within the step.
bool ImpactVisits::impactOf(const GapPair& pair, GapRow& row, Impact& impact) const
{
    const GapBody& a = scratch_.bodies[row.a];
    const GapBody& b = scratch_.bodies[row.b];
    const Vec3 relative = velocityAt(row, a, b);
    const double u = relative.dot(row.normal);
    const double s = std::max(row.gap, 0.0);
    const double atRest = openAt(row, a, b);
    const auto end = [&](double g) { return atRest + state_.dt * (u + 0.5 * g * state_.dt); };
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
        const double least = std::max(0.5 * strongerPull(a, b) * state_.dt, leastRebound_);
        if (u >= -state_.slowest || row.restitution * -u <= least) return false;
        impact = {&row, pair.isCarried, relative, 0.0, -row.restitution * u, Vec3::Zero()};
        return true;
    }
    const double closing = -u + std::sqrt(root);
    if (s > 0.0 && closing <= 0.0) return false;  // only the shifts bring them together
    const double time = s > 0.0 ? std::min(2.0 * s / closing, state_.dt) : 0.0;
    const double speed = u + g * time;
    if (speed >= -state_.slowest) return false;
    // What lies on something that lies on the ground falls back on it with all of gravity, even
    // if both are free to fall.
    const double most = strongerPull(a, b);
    const double pull = pair.isCarried ? most : (b.pull - a.pull).dot(row.normal);
    const bool lands = !pair.isCarried && -speed > kLands * most * state_.dt;
    const bool bounces = 2.0 * row.restitution * -speed > pull * (state_.dt - time);
    // The rest is left to contacts, unless a blow comes later in the step: until then the body
    // would run on. A stone that rolled sank by a hundredth of its size under one corner, while the
    // next came down.
    impact = {&row,
              pair.isCarried,
              relative + time * gravity,
              time,
              u - (1.0 + row.restitution) * speed,
              Vec3::Zero(),
              !lands && !bounces};
    return true;
}

/// True when nothing is left to be hit.
bool ImpactVisits::resolvePair(std::size_t p)
{
    thread_local std::vector<Impact> hits;
    for (int n = 0; n < state_.settings.collisionPairImpulses; ++n) {
        if (!gather(p, hits)) {
            left_.push_back(p);
            return false;
        }
        if (hits.empty()) return true;
        for (const Impact& hit : hits) hit.row->wasHit = true;
        if (hits.size() == 1) {
            applyOne(hits[0]);
        } else {
            applyTogether(hits);
        }
    }
    return false;
}

/// Fills `hits` with the first impacts of a pair, and those that come to its bodies, and on to
/// the others of these, at the same time. False when some might come through what is left to
/// somebody else.
bool ImpactVisits::gather(std::size_t p, std::vector<Impact>& hits)
{
    hits.clear();
    const double time = gatherFirst(p, hits);
    if (hits.empty() || !arrives(hits[0])) return true;
    ++clock_;
    state_.gatheredAt[scratch_.pairs[p].place] = clock_;
    thread_local std::vector<BodyId> toSpread;
    toSpread = {scratch_.pairs[p].bodies.a, scratch_.pairs[p].bodies.b};
    while (!toSpread.empty()) {
        const BodyId body = toSpread.back();
        toSpread.pop_back();
        for (const std::size_t q : state_.pairsOfBodies().of(state_.placeOf(body))) {
            const GapPair& pair = scratch_.pairs[q];
            if (pair.isCarried) continue;
            if (isOfHalf_ && pair.part == 2) return false;
            if (state_.gatheredAt[pair.place] == clock_) continue;
            state_.gatheredAt[pair.place] = clock_;
            const std::size_t before = hits.size();
            gatherFirst(q, hits);
            dropHits(hits, before, [&](const Impact& hit) {
                return !arrives(hit) || std::abs(hit.time - time) > kTogether * state_.dt;
            });
            const auto [a, b] = pair.bodies;
            if (hits.size() > before) toSpread.push_back(a == body ? b : a);
        }
    }
    return true;
}

/// Of all places of a pair that would be hit, those that are hit first: what would follow may
/// not, once these are answered. None if all would only precede a blow. Answers their time.
double ImpactVisits::gatherFirst(std::size_t p, std::vector<Impact>& hits) const
{
    const GapPair& pair = scratch_.pairs[p];
    const std::size_t before = hits.size();
    double earliest = state_.dt;
    bool isHit = false;
    Impact impact{};
    for (std::size_t r = pair.begin; r < pair.end; ++r) {
        if (!impactOf(pair, scratch_.rows[r], impact)) continue;
        hits.push_back(impact);
        earliest = std::min(earliest, impact.time);
        isHit = isHit || !impact.onlyPrecedes;
    }
    if (!isHit) {
        hits.resize(before);
        return state_.dt;
    }
    dropHits(hits, before,
             [&](const Impact& hit) { return hit.time > earliest + kTogether * state_.dt; });
    return earliest;
}

/// How far the centres slide along each other until the impact, if both are free to.
Vec3 ImpactVisits::slideUntil(const Impact& impact) const
{
    const GapRow& row = *impact.row;
    if (!row.movesA || !row.movesB) return Vec3::Zero();
    return impact.time * (scratch_.bodies[row.a].velocity - scratch_.bodies[row.b].velocity);
}

/// The row of an impact with the lever arms it has then: the place goes along with both.
/// Angular momentum is kept so, and energy too. Balls get the normal of then as well: aside of it
/// their arms would turn what nothing rubs. Keeps the row of now where it alone sees it coming.
/// Rows that have been foreseen have the arms of then.
GapRow ImpactVisits::rowAt(Impact& impact) const
{
    GapRow row = *impact.row;
    const GapBody& a = scratch_.bodies[row.a];
    const GapBody& b = scratch_.bodies[row.b];
    const Vec3 slid = slideUntil(impact);
    row.impulse = Vec3::Zero();
    row.squeeze = 0.0;  // presses for the whole step: a blow alone has none
    row.target = impact.velocityAfter;
    impact.slid = Vec3::Zero();
    if (row.isOfBlow) {
        const Vec3 bFromA = scratch_.seenAt[row.a].position - scratch_.seenAt[row.b].position;
        if (row.movesA && row.movesB) impact.slid = row.rB - row.rA - bFromA;
        return row;
    }
    if (row.movesA && row.movesB) {
        if (slid.isZero(0.0)) return row;
        if (row.isOfBalls) {
            const Vec3 aFromB = row.rB - row.rA + slid;
            const double share = row.rA.norm() / (row.rA.norm() + row.rB.norm());
            row.normal = aFromB.normalized();
            row.rA = -share * aFromB;
            row.rB = (1.0 - share) * aFromB;
        } else {
            row.rA -= 0.5 * slid;
            row.rB += 0.5 * slid;
        }
    } else {
        // Halfway between the surfaces is not where either is touched: a ball on a plane was given
        // a radius and half of what it fell in the step.
        const Vec3 half = 0.5 * std::max(row.gap, 0.0) * row.normal;
        row.rA += half;
        row.rB -= half;
    }
    const Vec3 velocity = velocityAt(row, a, b) + impact.time * gravityAt(row);
    const double speed = velocity.dot(row.normal);
    if (speed >= -state_.slowest) {
        row.rA = impact.row->rA;
        row.rB = impact.row->rB;
        row.normal = impact.row->normal;
        return row;
    }
    prepareRow(scratch_.bodies, row);
    row.target = velocityAt(row, a, b).dot(row.normal) - (1.0 + row.restitution) * speed;
    impact.velocity = velocity;
    impact.slid = slid;
    return row;
}

void ImpactVisits::applyOne(Impact& impact)
{
    const GapRow row = rowAt(impact);
    const GapBody& a = scratch_.bodies[row.a];
    const GapBody& b = scratch_.bodies[row.b];
    const Mat3 k = collisionMatrix(inertiaOf(a, row.movesA), row.rA) +
                   collisionMatrix(inertiaOf(b, row.movesB), row.rB);
    const ContactImpulse j =
        contactImpulse(k, impact.velocity, row.normal, row.restitution, row.friction);
    applyImpulses(row, j.impulse, impact.time);
    note(impact, row, j.impulse, j.kind);
}

/// A face that lands flat is hit at all its corners at once. One by one they would make it
/// spin.
void ImpactVisits::applyTogether(std::vector<Impact>& hits)
{
    double earliest = state_.dt, fastest = 0.0;
    thread_local HitTogether together;
    together.begin(scratch_.bodies);
    for (Impact& impact : hits) {
        together.add(rowAt(impact));
        earliest = std::min(earliest, impact.time);
        fastest = std::max(fastest, impact.velocity.norm());
    }
    const double left = hits.size() <= kHitsOfAFace ? kFaceIsSolved : kPairIsSolved;
    const bool isWhole = together.solve(left * fastest) == 1.0;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        const GapRow& row = together.rows()[i];
        applyImpulses(row, row.worldImpulse(), earliest);
        const FrictionCase kind = !isWhole      ? FrictionCase::fallback
                                  : sticks(row) ? FrictionCase::sticking
                                                : FrictionCase::sliding;
        note(hits[i], row, row.worldImpulse(), kind);
    }
}

void ImpactVisits::note(const Impact& impact, const GapRow& row, const Vec3& impulse,
                        FrictionCase kind)
{
    const double central = row.isOfBalls ? impulse.dot(row.normal) : 0.0;
    noted_.push_back({static_cast<std::size_t>(impact.row - scratch_.rows.data()), impulse,
                      impact.slid, kind, central * row.normal});
}

void ImpactVisits::applyImpulses(const GapRow& row, const Vec3& impulse, double time)
{
    // What follows from a blow comes no earlier: a box that fell on its like had this thrown at the
    // floor and back within the step, and turned 36 mm above it.
    for (const auto& [id, isMoved] : {std::pair{row.a, row.movesA}, std::pair{row.b, row.movesB}}) {
        if (isMoved && !changeOf(id).isByFixed) time = std::max(time, changeOf(id).earliest);
    }
    const auto strike = [&](BodyId id, const Vec3& r, const Vec3& j) {
        ImpactChange& change = changeOf(id);
        change.isByFixed = change.isByFixed && !(row.movesA && row.movesB);
        applyTo(scratch_.bodies[id], r, j, change, time);
    };
    if (row.movesA) strike(row.a, row.rA, impulse);
    if (row.movesB) strike(row.b, row.rB, -impulse);
}

/// What is struck goes on as before until the first blow, and then as after all of them; between
/// bodies that move this keeps angular momentum. Of floors and walls each blow has its own moment:
/// a ball that met both in one step stood a quarter of its height too high.
void ImpactVisits::applyTo(GapBody& body, const Vec3& r, const Vec3& impulse, ImpactChange& change,
                           double time)
{
    const Vec3 dv = body.inverseMass * impulse;
    const Vec3 dw = body.inverseInertia * r.cross(impulse);
    body.velocity += dv;
    body.spin += dw;
    body.angularImpulse += r.cross(impulse);
    change.velocity += dv;
    change.spin += dw;
    change.earliest = std::min(change.earliest, time);
    change.changedAt = clock_;
    body.hitAt = change.earliest;
    change.shift -= time * dv;
    change.turn -= time * dw;
    body.shift = change.isByFixed ? change.shift : Vec3(-change.earliest * change.velocity);
    body.turn = change.isByFixed ? change.turn : Vec3(-change.earliest * change.spin);
}

}  // namespace scree
