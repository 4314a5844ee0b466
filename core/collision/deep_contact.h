// What tells the way out of a body in which another is so deep that its features do not.
//
// A corner that has passed the middle of the other body is nearest to the far side of it, and the
// contact that it makes pulls the two together: two balls that began closer than half a diameter
// ended in one place. Edges deeper than a quarter are no contacts at all. But the largest ball that
// fits into a body has a depth in the other wherever it is, never more than the two overlap, and
// the slope of the other's field leads it out.
#pragma once

#include <optional>

#include "core/collision/relative_pair.h"

namespace scree {

/// The deeper of the two balls in the other body, if it is in there by more than a share of its
/// radius.
struct DeepContact {
    FeatureContact contact;
    bool isOfFirst;    ///< the ball: then the contact is that of `pair`, otherwise of `back`
    bool speaksAlone;  ///< the centre of the ball is inside: features can only mislead
};

/// `pair` and `back` are the two ways to look at two shapes. Planes have no far side.
std::optional<DeepContact> findDeepContact(const RelativePair& pair, const RelativePair& back);

/// Where there is none: a way that points of the bodies must have moved, added up, before there can
/// be one, or `far` if that is shorter [m].
double wayToDeepContact(const RelativePair& pair, const RelativePair& back, double far);

}  // namespace scree
