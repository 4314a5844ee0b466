#include "core/dynamics/gaps/gap_visit.h"

#include <algorithm>
#include <cmath>

namespace scree {
namespace {

void applyRow(const GapRow& row, GapBody& a, GapBody& b, const Vec3& impulse)
{
    if (row.movesA) applyTo(a, row.rA, impulse);
    if (row.movesB) applyTo(b, row.rB, -impulse);
}

void applyCouple(const GapRow& row, GapBody& a, GapBody& b, const Vec3& couple)
{
    if (row.movesA) applyCoupleTo(a, couple);
    if (row.movesB) applyCoupleTo(b, -couple);
}

/// Resistance to rolling and spinning: a couple that stops relative spin, as far as the normal
/// impulse and its lever arms allow. Answers by how much it changed the speed of a surface there
/// [m/s].  [A49]
///
/// Where friction holds the place the couple has to stop the centre too: friction follows, and
/// gives the body back most of what a couple for its spin alone had taken. With such couples a ball
/// that should have stood after 0.408 s crept on until 0.467 s: steps ended as soon as sweeps
/// changed little, and they always did.
double resistSpin(GapRow& row, GapBody& a, GapBody& b)
{
    const Mat3 response = coupleResponse(row, a, b);
    const double rolls = sticks(row) ? row.rollResponse : response.trace();
    const Vec3 w = a.spin - b.spin;
    const double wn = w.dot(row.normal), before = row.couple.dot(row.normal);
    const double most = row.spinningArm * row.impulse.x();
    const double about =
        std::clamp(before - wn / row.normal.dot(response * row.normal), -most, most);
    Vec3 across = row.couple - before * row.normal - (w - wn * row.normal) / rolls;
    const double length = across.norm(), limit = row.rollingArm * row.impulse.x();
    if (length > limit) across *= limit / length;
    const Vec3 change = about * row.normal + across - row.couple;
    row.couple += change;
    applyCouple(row, a, b, change);
    return (response * change).norm() * leverOf(row);
}

/// Of a row whose surfaces move along its normal with `un`.
double normalImpulse(const GapRow& row, double un)
{
    return std::max(0.0, row.impulse.x() - (un - row.target) / row.inverseNormalMass);
}

/// Friction of a row whose surfaces slide with (ut, us), by its normal impulse. Answers how much
/// that changed their speed at most.
double rub(GapRow& row, double ut, double us)
{
    const Vec3 before = row.impulse;
    const double* k = row.frictionMass;
    double t1 = before.y() - (k[0] * ut + k[1] * us);
    double t2 = before.z() - (k[1] * ut + k[2] * us);
    const double limit = row.frictionLimit();
    if (t1 * t1 + t2 * t2 > limit * limit) {
        // Projecting the sticking impulse would turn friction away from the sliding direction.
        t1 = before.y() - row.slideMass * ut;
        t2 = before.z() - row.slideMass * us;
        const double length = std::sqrt(t1 * t1 + t2 * t2);
        if (length > limit) {
            t1 *= limit / length;
            t2 *= limit / length;
        }
    }
    row.impulse.y() = t1;
    row.impulse.z() = t2;
    return std::max(std::abs(t1 - before.y()), std::abs(t2 - before.z())) / row.slideMass;
}

}  // namespace

double visitRow(GapRow& row, const Vec3& u)
{
    const Vec3 before = row.impulse;
    const double normal = normalImpulse(row, u.x()), pushed = normal - before.x();
    if (normal == 0.0 && row.squeeze == 0.0 && before.isZero(0.0)) return 0.0;
    row.impulse.x() = normal;
    const double rubbed = rub(row, u.y() + pushed * row.normalIntoFriction[0],
                              u.z() + pushed * row.normalIntoFriction[1]);
    return std::max(std::abs(pushed) * row.inverseNormalMass, rubbed);
}

double visitRow(GapRow& row, GapBody& a, GapBody& b)
{
    const Vec3 before = row.impulse, s = row.secondTangent();
    const auto velocity = [&] {
        const Vec3 u = velocityAt(row, a, b);
        return Vec3(u.dot(row.normal), u.dot(row.tangent), u.dot(s));
    };
    if (!row.resistsSpin()) {
        const double changed = visitRow(row, velocity());
        const Vec3 d = row.impulse - before;
        if (changed > 0.0)
            applyRow(row, a, b, d.x() * row.normal + d.y() * row.tangent + d.z() * s);
        return changed;
    }
    row.impulse.x() = normalImpulse(row, velocity().x());
    const double pushed = row.impulse.x() - before.x();
    applyRow(row, a, b, pushed * row.normal);
    double changed = std::max(std::abs(pushed) * row.inverseNormalMass, resistSpin(row, a, b));
    const Vec3 u = velocity();
    changed = std::max(changed, rub(row, u.y(), u.z()));
    const Vec3 d = row.impulse - before;
    applyRow(row, a, b, d.y() * row.tangent + d.z() * s);
    return changed;
}

}  // namespace scree
