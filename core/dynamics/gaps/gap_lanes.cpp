// Symbols: u relative velocity at a row, un, ut, us along its normal and tangents; j its impulse.
#include "core/dynamics/gaps/gap_lanes.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"

namespace scree {

/// The bodies of a batch, in registers while its rows are visited.
struct GapLanes::Motion {
    Lanes3 vA, wA, vB, wB;

    Motion(const Batch& batch, const std::vector<LaneBody>& bodies)
    {
        const auto gather = [&](const Side& side, Vec3 LaneBody::*part) {
            return lanesOf(bodies[side.body[0]].*part, bodies[side.body[1]].*part,
                           bodies[side.body[2]].*part, bodies[side.body[3]].*part);
        };
        vA = gather(batch.a, &LaneBody::velocity);
        wA = gather(batch.a, &LaneBody::spin);
        vB = gather(batch.b, &LaneBody::velocity);
        wB = gather(batch.b, &LaneBody::spin);
    }
    void store(const Batch& batch, std::vector<LaneBody>& bodies) const
    {
        for (int lane = 0; lane < kLanes; ++lane) {
            if (batch.a.isMovable[lane]) bodies[batch.a.body[lane]] = {vA.get(lane), wA.get(lane)};
            if (batch.b.isMovable[lane]) bodies[batch.b.body[lane]] = {vB.get(lane), wB.get(lane)};
        }
    }
};

namespace {

bool anyResistsSpin(const GapScratch& scratch, const GapIsland& island)
{
    return std::any_of(island.pairs.begin(), island.pairs.end(), [&](std::size_t i) {
        return std::ranges::any_of(scratch.rowsOf(scratch.pairs[i]), &GapRow::resistsSpin);
    });
}

/// `now` goes a share of its last way again, which then ends there.
template <class Number, class Vector>
void extrapolate(Number share, const Vector& before, Vector& way, Vector& now)
{
    const Vector step = share * way;
    way = step + (now - before);
    now += step;
}

/// How many rows from `first` on may share a batch: of a pair that rolls or is squeezed they may
/// have different turns and forces besides.
std::size_t rowsAlike(const GapScratch& scratch, std::size_t first, std::size_t end)
{
    const GapRow& row = scratch.rows[first];
    std::size_t last = first + 1;
    while (last < end && scratch.rows[last].squeeze == row.squeeze &&
           scratch.rows[last].turning == row.turning)
        ++last;
    return last - first;
}

/// Where friction holds the places of rows: as of one row, gap_rows.h.
LaneMask sticks(Lanes friction, Lanes squeeze, const Lanes3& impulse)
{
    const Lanes limit = kSlides * friction * (impulse.x + squeeze);
    return fma(impulse.y, impulse.y, impulse.z * impulse.z) < limit * limit;
}

}  // namespace

/// Calls work(half) for 0 and 1, at once if there are two.
template <class Work>
void GapLanes::inHalves(const Work& work)
{
    forEach(2, sections_[1].firstBody == sections_[1].endBody ? 2 : 1, work);
}

void GapLanes::build(const GapScratch& scratch, const GapIsland& island)
{
    const PairParts parts = partsOf(scratch, island, roomForParts_);
    resistsRolling_ = anyResistsSpin(scratch, island);
    beginsAnew_ = true;
    collectBodies(scratch, parts);
    inHalves([&](std::size_t half) { layOut(scratch, parts[half], sections_[half]); });
    std::fill(firstFree_.begin(), firstFree_.end(), 0);
    layOut(scratch, parts[2], sections_[2]);
}

void GapLanes::collectBodies(const GapScratch& scratch, const PairParts& parts)
{
    for (std::size_t i = 1; i < idOf_.size(); ++i) placeOf_[idOf_[i]] = 0;
    placeOf_.resize(scratch.bodies.size(), 0);
    idOf_.assign(1, -1);
    const auto collect = [&](std::span<const std::size_t> pairs, bool movable) {
        for (const std::size_t i : pairs) {
            for (const BodyId body : {scratch.pairs[i].bodies.a, scratch.pairs[i].bodies.b}) {
                const bool isMovable = scratch.bodies[body].isMovable();
                if (placeOf_[body] != 0 || isMovable != movable) continue;
                placeOf_[body] = static_cast<std::int32_t>(idOf_.size());
                idOf_.push_back(body);
            }
        }
    };
    for (std::size_t part = 0; part < parts.size(); ++part) {
        sections_[part].firstBody = idOf_.size();
        collect(parts[part], true);
        sections_[part].endBody = idOf_.size();
    }
    for (std::span<const std::size_t> pairs : parts) collect(pairs, false);
    bodies_.assign(idOf_.size(), {});
    ways_.resize(idOf_.size());
    firstFree_.assign(idOf_.size(), 0);
    for (std::size_t i = 1; i < idOf_.size(); ++i) {
        const GapBody& body = scratch.bodies[idOf_[i]];
        bodies_[i] = {body.velocity, body.spin};
    }
}

void GapLanes::layOut(const GapScratch& scratch, std::span<const std::size_t> pairs,
                      Section& section)
{
    schedule(scratch, pairs, section);
    std::size_t rowCount = 0;
    for (Batch& batch : section.batches) {
        batch.end += rowCount;
        batch.begin = rowCount;
        rowCount = batch.end;
    }
    section.rows.resize(rowCount);
    section.rolls.resize(resistsRolling_ ? rowCount : 0);
    for (Batch& batch : section.batches) fill(scratch, batch, section);
}

/// The first batch with an idle lane for so many rows, not before `earliest`; a new one if none is.
std::int32_t GapLanes::batchFor(std::size_t rows, std::int32_t earliest, Section& section) const
{
    std::vector<Batch>& batches = section.batches;
    std::vector<std::int32_t>& open = section.open[rows];
    const auto found = std::lower_bound(open.begin(), open.end(), earliest);
    if (found != open.end()) {
        const std::int32_t place = *found;
        if (batches[place].lanesUsed == kLanes - 1) open.erase(found);
        return place;
    }
    const auto place = static_cast<std::int32_t>(batches.size());
    Batch& batch = batches.emplace_back();
    batch.end = rows;
    for (int lane = 0; lane < kLanes; ++lane) {
        batch.a.body[lane] = batch.b.body[lane] = 0;
        batch.a.isMovable[lane] = batch.b.isMovable[lane] = false;
    }
    open.push_back(place);
    return place;
}

/// The rows of every pair go into batches after those of the pairs before it that share a body with
/// it: the outcome of a sweep is that of visiting the pairs one by one.
void GapLanes::schedule(const GapScratch& scratch, std::span<const std::size_t> pairs,
                        Section& section)
{
    section.batches.clear();
    for (std::vector<std::int32_t>& open : section.open) open.clear();
    section.residual = section.squaredSpeed = section.energy = kNoLanes;
    for (const std::size_t i : pairs) {
        const GapPair& pair = scratch.pairs[i];
        const std::int32_t a = placeOf_[pair.bodies.a], b = placeOf_[pair.bodies.b];
        const bool movesA = scratch.bodies[pair.bodies.a].isMovable();
        const bool movesB = scratch.bodies[pair.bodies.b].isMovable();
        for (std::size_t r = pair.begin, count; r < pair.end; r += count) {
            count = rowsAlike(scratch, r, std::min(r + kRowsTogether, pair.end));
            const std::int32_t earliest =
                std::max(movesA ? firstFree_[a] : 0, movesB ? firstFree_[b] : 0);
            const std::int32_t place = batchFor(count, earliest, section);
            Batch& batch = section.batches[place];
            const int lane = batch.lanesUsed++;
            batch.from[lane] = static_cast<std::int32_t>(r);
            batch.a.body[lane] = a;
            batch.b.body[lane] = b;
            batch.a.isMovable[lane] = movesA;
            batch.b.isMovable[lane] = movesB;
            if (movesA) firstFree_[a] = place + 1;
            if (movesB) firstFree_[b] = place + 1;
        }
    }
}

void GapLanes::fill(const GapScratch& scratch, Batch& batch, Section& section)
{
    for (std::size_t r = batch.begin; r < batch.end; ++r) {
        if (batch.lanesUsed < kLanes) section.rows[r] = Row{};
        if (!section.rolls.empty()) section.rolls[r] = Roll{};
    }
    for (int lane = 0; lane < batch.lanesUsed; ++lane) fillLane(scratch, batch, lane, section);
}

void GapLanes::fillLane(const GapScratch& scratch, Batch& batch, int lane, Section& section)
{
    const GapRow* from = &scratch.rows[batch.from[lane]];
    const auto place = [&](Side& side, const GapBody& body, bool moves) {
        if (!moves) return;
        side.inverseMass[lane] = body.inverseMass;
        side.inverseInertia.set(lane, body.inverseInertia);
    };
    place(batch.a, scratch.bodies[from->a], from->movesA);
    place(batch.b, scratch.bodies[from->b], from->movesB);
    batch.bFromA.set(lane, from->rB - from->rA);
    batch.turning.set(lane, from->turning);
    batch.squeeze[lane] = from->squeeze;
    for (std::size_t r = batch.begin; r < batch.end; ++r, ++from) {
        Row& row = section.rows[r];
        row.rA.set(lane, from->rA);
        row.normal.set(lane, from->normal);
        row.tangent.set(lane, from->tangent);
        row.target[lane] = from->target;
        row.friction[lane] = from->friction;
        row.normalMass[lane] = 1.0 / from->inverseNormalMass;
        row.inverseNormalMass[lane] = from->inverseNormalMass;
        row.turnsIntoTangent[lane] = from->normalIntoFriction[0];
        row.turnsIntoSecond[lane] = from->normalIntoFriction[1];
        row.massTt[lane] = from->frictionMass[0];
        row.massTs[lane] = from->frictionMass[1];
        row.massSs[lane] = from->frictionMass[2];
        row.slideMass[lane] = from->slideMass;
        row.inverseSlideMass[lane] = 1.0 / from->slideMass;
        row.impulse.set(lane, from->impulse);
        if (!from->resistsSpin()) continue;
        Roll& roll = section.rolls[r];
        const Mat3 response =
            coupleResponse(*from, scratch.bodies[from->a], scratch.bodies[from->b]);
        roll.rollingArm[lane] = from->rollingArm;
        roll.spinningArm[lane] = from->spinningArm;
        roll.lever[lane] = leverOf(*from);
        roll.rollMass[lane] = 1.0 / from->rollResponse;
        roll.slipMass[lane] = 1.0 / response.trace();
        roll.spinMass[lane] = 1.0 / from->normal.dot(response * from->normal);
        roll.couple.set(lane, from->couple);
    }
}

/// `change` of the impulse, along normal and tangents.
inline void GapLanes::apply(const Row& row, const Batch& batch, const Lanes3& change,
                            Motion& motion)
{
    const Lanes3 second = cross(row.normal, row.tangent);
    const Lanes3 j = fma(change.z, second, fma(change.y, row.tangent, change.x * row.normal));
    motion.vA = fma(batch.a.inverseMass, j, motion.vA);
    motion.wA += batch.a.inverseInertia * cross(row.rA, j);
    motion.vB = fnma(batch.b.inverseMass, j, motion.vB);
    motion.wB -= batch.b.inverseInertia * cross(row.rA + batch.bFromA, j);
}

inline void GapLanes::applyCouple(const Batch& batch, const Lanes3& couple, Motion& motion)
{
    motion.wA += batch.a.inverseInertia * couple;
    motion.wB -= batch.b.inverseInertia * couple;
}

inline Lanes3 GapLanes::velocityAt(const Row& row, const Batch& batch, const Motion& motion)
{
    return motion.vA + cross(motion.wA, row.rA) - motion.vB -
           cross(motion.wB, row.rA + batch.bFromA) + batch.turning;
}

/// resistSpin of the plain twin without branches.
inline Lanes GapLanes::resistSpin(std::size_t place, const Batch& batch, Motion& motion,
                                  Section& section)
{
    const Row& row = section.rows[place];
    Roll& roll = section.rolls[place];
    const Lanes3 w = motion.wA - motion.wB, old = roll.couple;
    const Lanes wn = dot(w, row.normal), before = dot(old, row.normal);
    const Lanes most = roll.spinningArm * row.impulse.x;
    const Lanes about = minOf(maxOf(fnma(wn, roll.spinMass, before), -most), most);
    const Lanes mass =
        sticks(row.friction, batch.squeeze, row.impulse) ? roll.rollMass : roll.slipMass;
    const Lanes3 across = fnma(mass, fnma(wn, row.normal, w), fnma(before, row.normal, old));
    const Lanes length = sqrtOf(dot(across, across)), limit = roll.rollingArm * row.impulse.x;
    const Lanes shorter = length > limit ? limit / length : lanesOf(1.0);
    roll.couple = fma(about, row.normal, shorter * across);
    applyCouple(batch, roll.couple - old, motion);
    const Lanes3 change = motion.wA - motion.wB - w;
    return roll.lever * sqrtOf(dot(change, change));
}

/// visitRow without branches, where surfaces move with u. Friction sees what the normal impulse
/// changes without that having been applied, unless a couple comes between them.
template <bool kRolls>
inline void GapLanes::visit(std::size_t place, const Batch& batch, const Lanes3& u, Motion& motion,
                            Section& section)
{
    Row& row = section.rows[place];
    const Lanes3 old = row.impulse;
    const Lanes3 second = cross(row.normal, row.tangent);
    const Lanes un = dot(u, row.normal);
    const Lanes normal = maxOf(kNoLanes, fnma(un - row.target, row.normalMass, old.x));
    const Lanes pushed = normal - old.x;
    Lanes ut, us;
    if constexpr (kRolls) {
        row.impulse.x = normal;
        apply(row, batch, {pushed, kNoLanes, kNoLanes}, motion);
        section.residual = maxOf(section.residual, resistSpin(place, batch, motion, section));
        const Lanes3 turned = velocityAt(row, batch, motion);
        ut = dot(turned, row.tangent);
        us = dot(turned, second);
    } else {
        ut = fma(pushed, row.turnsIntoTangent, dot(u, row.tangent));
        us = fma(pushed, row.turnsIntoSecond, dot(u, second));
    }
    const Lanes stickT = fnma(row.massTt, ut, fnma(row.massTs, us, old.y));
    const Lanes stickS = fnma(row.massTs, ut, fnma(row.massSs, us, old.z));
    const Lanes limit = row.friction * (normal + batch.squeeze);
    const auto slides = fma(stickT, stickT, stickS * stickS) > limit * limit;
    const Lanes slideT = fnma(row.slideMass, ut, old.y), slideS = fnma(row.slideMass, us, old.z);
    const Lanes length = sqrtOf(fma(slideT, slideT, slideS * slideS));
    const Lanes shorter = length > limit ? limit / length : lanesOf(1.0);
    row.impulse = {normal, slides ? shorter * slideT : stickT, slides ? shorter * slideS : stickS};
    const Lanes3 change = row.impulse - old;
    apply(row, batch, {kRolls ? kNoLanes : change.x, change.y, change.z}, motion);
    const Lanes changed = maxOf(absOf(pushed) * row.inverseNormalMass,
                                maxOf(absOf(change.y), absOf(change.z)) * row.inverseSlideMass);
    section.residual = maxOf(section.residual, changed);
}

void GapLanes::begin(Section& section)
{
    for (const Batch& batch : section.batches) {
        Motion motion(batch, bodies_);
        for (std::size_t r = batch.begin; r < batch.end; ++r) {
            apply(section.rows[r], batch, section.rows[r].impulse, motion);
            if (resistsRolling_) applyCouple(batch, section.rolls[r].couple, motion);
        }
        motion.store(batch, bodies_);
    }
}

/// What the last goOn has decided, for the bodies of a section.
void GapLanes::extrapolateBodies(const Section& section)
{
    for (std::size_t i = section.firstBody; i < section.endBody; ++i) {
        LaneBody& body = bodies_[i];
        auto& [before, way] = ways_[i];
        if (beginsAnew_) {
            way = LaneBody{};
        } else {
            extrapolate(share_, before.velocity, way.velocity, body.velocity);
            extrapolate(share_, before.spin, way.spin, body.spin);
        }
        before = body;
    }
}

/// The same for a row.
template <bool kRolls>
inline void GapLanes::extrapolateRow(Section& section, std::size_t place) const
{
    const auto extrapolateOne = [&](Lanes3& before, Lanes3& way, Lanes3& now) {
        if (beginsAnew_)
            way = Lanes3{};
        else
            extrapolate(lanesOf(share_), before, way, now);
        before = now;
    };
    Row& row = section.rows[place];
    extrapolateOne(row.before, row.way, row.impulse);
    if constexpr (kRolls) {
        Roll& roll = section.rolls[place];
        extrapolateOne(roll.before, roll.way, roll.couple);
    }
}

template <bool kRolls>
void GapLanes::sweepUp(Section& section)
{
    extrapolateBodies(section);
    section.residual = section.squaredSpeed = kNoLanes;
    for (const Batch& batch : section.batches) {
        Motion motion(batch, bodies_);
        for (std::size_t r = batch.begin; r < batch.end; ++r) {
            extrapolateRow<kRolls>(section, r);
            const Lanes3 u = velocityAt(section.rows[r], batch, motion);
            section.squaredSpeed = maxOf(section.squaredSpeed, dot(u, u));
            visit<kRolls>(r, batch, u, motion, section);
        }
        motion.store(batch, bodies_);
    }
}

template <bool kRolls>
void GapLanes::sweepDown(Section& section)
{
    section.energy = kNoLanes;
    for (std::size_t place = section.batches.size(); place-- > 0;) {
        const Batch& batch = section.batches[place];
        Motion motion(batch, bodies_);
        for (std::size_t r = batch.end; r-- > batch.begin;) {
            Row& row = section.rows[r];
            visit<kRolls>(r, batch, velocityAt(row, batch, motion), motion, section);
            const Lanes3 d = row.impulse - row.before;
            const Lanes sideways = fma(d.y, d.y, d.z * d.z);
            section.energy = fma(row.inverseNormalMass, d.x * d.x, section.energy);
            section.energy = fma(row.inverseSlideMass, sideways, section.energy);
        }
        motion.store(batch, bodies_);
    }
}

void GapLanes::begin()
{
    inHalves([&](std::size_t half) { begin(sections_[half]); });
    begin(sections_[2]);
}

GapSweep GapLanes::sweep()
{
    const auto up = resistsRolling_ ? &GapLanes::sweepUp<true> : &GapLanes::sweepUp<false>;
    const auto down = resistsRolling_ ? &GapLanes::sweepDown<true> : &GapLanes::sweepDown<false>;
    inHalves([&](std::size_t half) { (this->*up)(sections_[half]); });
    (this->*up)(sections_[2]);
    (this->*down)(sections_[2]);
    inHalves([&](std::size_t half) { (this->*down)(sections_[half]); });
    GapSweep swept;
    for (const Section& section : sections_) {
        swept.residual = std::max(swept.residual, largestOf(section.residual));
        swept.fastest = std::max(swept.fastest, std::sqrt(largestOf(section.squaredSpeed)));
        swept.energy += sumOf(section.energy);
    }
    return swept;
}

void GapLanes::goOn(double share)
{
    share_ = share;
    beginsAnew_ = share > 1.0;
}

/// Half of what impulses do they do while bodies move as before, the other half as they move now;
/// without an error the latter is friction alone.
GapWork GapLanes::work(const Section& section, const GapScratch& scratch) const
{
    GapWork work;
    for (std::size_t i = section.firstBody; i < section.endBody; ++i) {
        const GapBody& before = scratch.bodies[idOf_[i]];
        const Vec3 push = (bodies_[i].velocity - before.velocity) / before.inverseMass;
        const Vec3 twist = before.inverseInertia.inverse() * (bodies_[i].spin - before.spin);
        const auto against = [&](const Vec3& velocity, const Vec3& spin) {
            return 0.5 *
                   (push.dot(bodies_[i].velocity - velocity) + twist.dot(bodies_[i].spin - spin));
        };
        work.taken += against(before.velocityBefore, before.spinBefore);
        work.borne += against(before.velocity, before.spin);
    }
    Lanes wrong = kNoLanes, right = kNoLanes;
    for (const Batch& batch : section.batches) {
        const Motion motion(batch, bodies_);
        for (std::size_t r = batch.begin; r < batch.end; ++r) {
            const Row& row = section.rows[r];
            const Lanes3 u = velocityAt(row, batch, motion);
            const Lanes ut = dot(u, row.tangent), us = dot(u, cross(row.normal, row.tangent));
            const Lanes pushes = row.impulse.x * (dot(u, row.normal) - row.target);
            const Lanes rubs = fma(row.impulse.y, ut, row.impulse.z * us);
            wrong += maxOf(kNoLanes, pushes) + maxOf(kNoLanes, rubs);
            right += maxOf(kNoLanes, -pushes) + maxOf(kNoLanes, -rubs);
        }
    }
    work.taken += sumOf(right);
    work.borne += sumOf(right);
    work.wrong = sumOf(wrong);
    return work;
}

GapWork GapLanes::work(const GapScratch& scratch) const
{
    GapWork sum;
    for (const Section& section : sections_) {
        const GapWork of = work(section, scratch);
        sum.taken += of.taken;
        sum.borne += of.borne;
        sum.wrong += of.wrong;
    }
    return sum;
}

void GapLanes::store(const Section& section, GapScratch& scratch) const
{
    for (std::size_t i = section.firstBody; i < section.endBody; ++i) {
        scratch.bodies[idOf_[i]].velocity = bodies_[i].velocity;
        scratch.bodies[idOf_[i]].spin = bodies_[i].spin;
    }
    for (const Batch& batch : section.batches) {
        for (int lane = 0; lane < batch.lanesUsed; ++lane) {
            GapRow* to = &scratch.rows[batch.from[lane]];
            for (std::size_t r = batch.begin; r < batch.end; ++r, ++to) {
                to->impulse = section.rows[r].impulse.get(lane);
                if (resistsRolling_) to->couple = section.rolls[r].couple.get(lane);
            }
        }
    }
}

void GapLanes::store(GapScratch& scratch)
{
    inHalves([&](std::size_t half) { store(sections_[half], scratch); });
    store(sections_[2], scratch);
}

}  // namespace scree
