// How deep two bodies are told to overlap.
#pragma once

#include <vector>

#include "core/collision/near_features.h"
#include "core/dynamics/gaps/gap_scratch.h"

namespace scree::test {

/// Depth of the deepest contact of two bodies, sought within 3 mm [m].
inline double deepestContact(const Shape& a, const Pose& poseA, const Shape& b, const Pose& poseB)
{
    std::vector<GapContact> contacts;
    NearFeatures().findContacts({&a, &b, poseA, poseB}, 0.003, contacts);
    return deepestOf(contacts);
}

}  // namespace scree::test
