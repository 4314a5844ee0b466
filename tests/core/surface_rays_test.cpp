#include <gtest/gtest.h>

#include <limits>

#include "core/geometry/primitives.h"
#include "core/geometry/surface_rays.h"

namespace scree {
namespace {

// Embree would have ended the program.
TEST(SurfaceRays, ARayFromNowhereHitsNothing)
{
    const SurfaceRays rays(makeBox(Vec3::Ones(), {1, 1, 1}));
    const auto hits = [&](double x, double alongX) {
        return rays.firstHit({x, 0.1, 0.2}, {alongX, 0.0, 0.0}, 10.0, SurfaceRays::Facing::any)
            .has_value();
    };
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    constexpr double kEndless = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(hits(3.0, -1.0));
    for (const double x : {kNone, kEndless, -kEndless, 1e30, 1e300})
        EXPECT_FALSE(hits(x, -1.0)) << x;
    EXPECT_FALSE(hits(3.0, kNone));
}

}  // namespace
}  // namespace scree
