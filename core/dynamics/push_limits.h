// How far one push of push-out may go, by either method.  [A52]
#pragma once

#include <cstdint>

#include "core/geometry/shape.h"

namespace scree {

struct PushOutTally {
    std::int64_t pushes = 0;
    std::int64_t cut = 0;  ///< longer than half the inner thickness, or turning more than 0.1 rad

    PushOutTally& operator+=(const PushOutTally& other)
    {
        pushes += other.pushes;
        cut += other.cut;
        return *this;
    }
};

/// The share of a push that keeps a body within the limits of one push: half the inner thickness,
/// 0.1 rad.
double admissibleShare(const Shape& shape, const Vec3& shift, const Vec3& turn);

}  // namespace scree
