#include "render/look.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

SceneDescription twoBodies(const std::string& a, const std::string& b)
{
    SceneDescription scene;
    scene.bodies = {{a, 0, "steel", 1.0, true}, {b, 0, "steel", 1.0, true}};
    return scene;
}

TEST(VariedLooks, BodiesOfAHeapDifferALittle)
{
    const std::vector<Look> looks(2);
    const auto varied = variedLooks(twoBodies("ring_1", "ring_2"), looks);
    EXPECT_GT((varied[0].color - varied[1].color).norm(), 1e-3);
    for (const Look& look : varied) EXPECT_LT((look.color - looks[0].color).norm(), 0.4);
}

TEST(VariedLooks, ALookDependsOnTheNameAlone)
{
    const std::vector<Look> looks(2);
    const auto first = variedLooks(twoBodies("ring_1", "ring_2"), looks);
    const auto swapped = variedLooks(twoBodies("other", "ring_1"), looks);
    EXPECT_EQ(first[0].color, swapped[1].color);
}

TEST(VariedLooks, WhatStandsStillKeepsItsColor)
{
    SceneDescription scene = twoBodies("ground", "ring");
    scene.bodies[0].moves = false;
    const std::vector<Look> looks(2);
    EXPECT_EQ(variedLooks(scene, looks)[0].color, looks[0].color);
}

}  // namespace
}  // namespace scree
