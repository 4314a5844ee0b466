#include "core/collision/contact_with_gap.h"

#include <algorithm>

namespace scree {

double deepestOf(const std::vector<GapContact>& contacts)
{
    double deepest = 0.0;
    for (const GapContact& contact : contacts) deepest = std::max(deepest, -contact.gap);
    return deepest;
}

GapContact movedAlong(const GapContact& contact, const PairMove& move)
{
    const Vec3 half = 0.5 * contact.gap * contact.normal;
    const Vec3 onA = move.turnA * (contact.rA + half);
    const Vec3 onB = move.turnB * (contact.rA - half - move.fromAToBBefore) + move.fromAToB;
    const Vec3 withA = move.turnA * contact.normal, withB = move.turnB * contact.normal;
    const FeatureKind kind = kindOf(contact.feature);
    GapContact moved{contact.feature, Vec3::Zero(),
                     kind == FeatureKind::cornerOfA   ? withB
                     : kind == FeatureKind::cornerOfB ? withA
                                                      : Vec3((withA + withB).normalized()),
                     0.0};
    moved.gap = moved.normal.dot(onA - onB);
    const Vec3 halfNow = 0.5 * moved.gap * moved.normal;
    moved.rA = kind == FeatureKind::cornerOfA   ? Vec3(onA - halfNow)
               : kind == FeatureKind::cornerOfB ? Vec3(onB + halfNow)
                                                : Vec3(0.5 * (onA + onB));
    return moved;
}

}  // namespace scree
