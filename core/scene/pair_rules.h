// How the properties of two materials become those of their contact.  [A27]
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/scene/body.h"

namespace scree {

enum class CombineRule { minimum, maximum, mean, geometric, multiply };

/// Of two numbers ≥ 0.
inline double combined(CombineRule rule, double a, double b)
{
    switch (rule) {
        case CombineRule::minimum:
            return std::min(a, b);
        case CombineRule::maximum:
            return std::max(a, b);
        case CombineRule::mean:
            return 0.5 * (a + b);
        case CombineRule::geometric:
            return std::sqrt(a * b);
        case CombineRule::multiply:
            return a * b;
    }
    return a;
}

/// What two materials do against each other, instead of what the rules make of them.
struct MaterialPair {
    MaterialId a = 0, b = 0;  ///< in either order; they may be the same
    std::optional<double> friction, restitution;
};

}  // namespace scree
