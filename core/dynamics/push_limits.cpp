#include "core/dynamics/push_limits.h"

#include <algorithm>

namespace scree {
namespace {

constexpr double kMostTurn = 0.1;  // per push [rad]

}  // namespace

double admissibleShare(const Shape& shape, const Vec3& shift, const Vec3& turn)
{
    const double longest = 0.5 * shape.innerThickness;
    double share = 1.0;
    if (shift.norm() > longest) share = std::min(share, longest / shift.norm());
    if (turn.norm() > kMostTurn) share = std::min(share, kMostTurn / turn.norm());
    return share;
}

}  // namespace scree
