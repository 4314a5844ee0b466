// Sheets as a shot makes them.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/dynamics/stepper.h"
#include "io/build_world.h"
#include "io/shot_parser.h"

namespace scree::test {
namespace {

// Two thousand times as long as they are thick: faces of the far side counted as beside an edge of
// the near one, and the upper sheet was two thicknesses in the lower.
TEST(Sheets, WhatFallsOnItsLikeDoesNotGoThrough)
{
    const Shot shot = parseShotText(R"(
scree = 1
[shot]
name = "sheets"
[material.steel]
friction = 0.5
restitution = 0.2
density = 1000
[shape.sheet]
box = { size = [2, 0.001, 1], segments = [1, 1, 1] }
[[body]]
name = "floor"
plane = { normal = [0, 1, 0] }
material = "steel"
motion = "static"
[[body]]
name = "sheet"
shape = "sheet"
material = "steel"
rotation = [2, 0, 1.2]
position = [0, 0.25, 0]
grid = { count = [1, 2, 1], spacing = [0, 0.15, 0] }
)",
                                    "sheets.toml");
    World world = buildWorld(shot);
    Stepper stepper(shot.settings);
    double deepest = 0.0;
    for (int frame = 0; frame < 10; ++frame) {
        const FrameReport report = stepper.advanceFrame(world, world.frameDuration);
        deepest = std::max(deepest, report.sum.deepestAfterPushOut);
    }
    EXPECT_LT(deepest, 0.2e-3);
}

}  // namespace
}  // namespace scree::test
