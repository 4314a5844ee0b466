// What method `scree` remembers of its contacts from one step to the next. It is state: a resumed
// run that had forgotten it would not go on to the same bits.
#pragma once

#include <cstdint>
#include <vector>

#include "core/scene/body.h"

namespace scree {

/// The impulse that a place of contact needed in the last step. What held a heap then holds it now.
struct RememberedContact {
    BodyId a = 0, b = 0;
    std::uint64_t feature = 0;    ///< near_features.h
    Vec3 place = Vec3::Zero();    ///< in A's object frame [m]
    Vec3 impulse = Vec3::Zero();  ///< on A, world [N s]
};

struct ContactMemory {
    std::vector<RememberedContact> contacts;  ///< sorted by bodies
    double dt = 0.0;  ///< of the step that wrote it [s]; 0: nothing is known
};

}  // namespace scree
