#include "core/collision/relative_pair.h"

#include <limits>

namespace scree {

double smallerRadius(const Shape& a, const Shape& b)
{
    double smaller = std::numeric_limits<double>::infinity();
    for (const Shape* shape : {&a, &b}) {
        if (!shape->isPlane) smaller = std::min(smaller, shape->boundingRadius);
    }
    return smaller;
}

}  // namespace scree
