// The kinetic energy of bodies as the passes of method `scree` hold them.
#pragma once

#include <vector>

#include "core/dynamics/gaps/gap_rows.h"

namespace scree::test {

/// Of those that can be moved [J].
inline double kineticEnergy(const std::vector<GapBody>& bodies)
{
    double sum = 0.0;
    for (const GapBody& body : bodies) {
        if (body.inverseMass == 0.0) continue;
        sum += 0.5 * (body.velocity.squaredNorm() / body.inverseMass +
                      body.spin.dot(body.inverseInertia.inverse() * body.spin));
    }
    return sum;
}

}  // namespace scree::test
