// How often surfaces wind around a point, against what can be counted.
#include "core/geometry/winding_number.h"

#include <gtest/gtest.h>

#include "core/geometry/primitives.h"
#include "tests/support/both_meshes.h"

namespace scree {
namespace {

TEST(WindingNumber, IsOneInsideAndNoneOutsideRightUpToTheSurface)
{
    const WindingNumber winding(makeTorus(1.0, 0.25, {16, 10}));
    for (const double x : {0.76, 0.8, 1.0, 1.2, 1.249})
        EXPECT_NEAR(winding.at({x, 0.0, 0.0}), 1.0, 0.03) << x;
    for (const double x : {0.0, 0.5, 0.74, 1.251, 1.3, 3.0})
        EXPECT_NEAR(winding.at({x, 0.0, 0.0}), 0.0, 0.03) << x;
}

TEST(WindingNumber, CountsSurfacesAroundEachOtherAndThoseThatFaceInward)
{
    const TriMesh small = makeSphere(1.0, 2), large = makeSphere(2.0, 2);
    TriMesh turned = small;
    turned.triangles.row(1).swap(turned.triangles.row(2));
    const Vec3 inBoth(0.3, 0.2, -0.1), inOne(1.5, 0.1, 0.2);
    EXPECT_NEAR(WindingNumber(test::both(small, large)).at(inBoth), 2.0, 0.03);
    EXPECT_NEAR(WindingNumber(test::both(small, large)).at(inOne), 1.0, 0.03);
    EXPECT_NEAR(WindingNumber(test::both(turned, large)).at(inBoth), 0.0, 0.03);
    EXPECT_NEAR(WindingNumber(turned).at(inBoth), -1.0, 0.03);
    const TriMesh four = test::both(test::both(small, small), test::both(small, small));
    EXPECT_NEAR(WindingNumber(four).at(inBoth), 4.0, 0.03);
}

TEST(WindingNumber, OfAnOpenBoxIsTheShareOfSightThatItTakes)
{
    TriMesh box = makeBox(Vec3::Ones(), {1, 1, 1});
    int kept = 0;
    for (int f = 0; f < box.triangles.cols(); ++f) {
        const bool isLid = (cornersOf(box, f).normal() - Vec3::UnitY()).norm() < 1e-9;
        if (!isLid) box.triangles.col(kept++) = box.triangles.col(f);
    }
    box.triangles.conservativeResize(3, kept);
    EXPECT_NEAR(WindingNumber(box).at(Vec3::Zero()), 5.0 / 6.0, 1e-12);
    EXPECT_NEAR(WindingNumber(box).at(Vec3::UnitY()), 1.0 / 6.0, 1e-12);
}

}  // namespace
}  // namespace scree
