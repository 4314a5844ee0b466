// Marks of contacts lie where the camera sees their points.
#include "render/overlay.h"

#include <gtest/gtest.h>

namespace scree {
namespace {

/// How far the pixel differs from a black picture.
float light(const Image& image, int x, int y)
{
    return image.at(x, y).maxCoeff();
}

TEST(DrawLine, CoversItsWidthAndNothingElse)
{
    Image image(40, 20);
    drawLine(image, {5.0, 10.0}, {35.0, 10.0}, 2.0, Color::Ones());
    for (const int x : {5, 20, 34}) {
        EXPECT_FLOAT_EQ(light(image, x, 9), 1.0f);
        EXPECT_FLOAT_EQ(light(image, x, 10), 1.0f);
        EXPECT_FLOAT_EQ(light(image, x, 7), 0.0f);
        EXPECT_FLOAT_EQ(light(image, x, 12), 0.0f);
    }
    EXPECT_FLOAT_EQ(light(image, 2, 10), 0.0f);
    EXPECT_FLOAT_EQ(light(image, 38, 10), 0.0f);
}

TEST(DrawLine, TheShareOfAPixelThatItCoversIsItsOpacity)
{
    Image image(20, 20);
    drawLine(image, {5.0, 10.25}, {15.0, 10.25}, 2.0, Color::Ones());
    EXPECT_NEAR(light(image, 10, 9), 0.75f, 1e-5);
    EXPECT_NEAR(light(image, 10, 10), 1.0f, 1e-5);
    EXPECT_NEAR(light(image, 10, 11), 0.25f, 1e-5);
}

TEST(DrawLine, OutsideThePictureThereIsNothingToDraw)
{
    Image image(20, 20);
    drawLine(image, {-50.0, -50.0}, {-10.0, -10.0}, 3.0, Color::Ones());
    drawLine(image, {25.0, 3.0}, {90.0, 3.0}, 3.0, Color::Ones());
    for (const float value : image.values) EXPECT_EQ(value, 0.0f);
}

TEST(DrawContacts, DotNormalAndForceAreSeenFromTheContactPoint)
{
    // 10 units in front of the eye, 90° see 20 units: 10 pixels are one unit. The point is in the
    // middle of a pixel, so that thin lines cover theirs whole.
    Image image(200, 200);
    const Camera camera{{0.0, 0.0, 10.0}, Vec3::Zero(), Vec3::UnitY(), 90.0};
    drawContacts(image, camera, {{{3.05, 1.95, 0.0}, {0.0, 4.0, 0.0}, {-5.0, 0.0, 0.0}}});
    const auto isLike = [&](int x, int y, const Color& color) {
        return (image.at(x, y) - color).norm() < 0.05f;
    };
    EXPECT_TRUE(isLike(130, 80, kContactColor));
    EXPECT_TRUE(isLike(130, 60, kNormalColor));
    EXPECT_TRUE(isLike(130, 45, kNormalColor));
    EXPECT_TRUE(isLike(100, 80, kForceColor));
    EXPECT_EQ(light(image, 130, 30), 0.0f) << "the normal is 4 units long";
    EXPECT_EQ(light(image, 70, 80), 0.0f) << "the force is 5 units long";
    EXPECT_EQ(light(image, 150, 80), 0.0f);
}

TEST(DrawContacts, WhatIsBehindTheEyeIsNotDrawn)
{
    Image image(64, 64);
    const Camera camera{{0.0, 0.0, 10.0}, Vec3::Zero(), Vec3::UnitY(), 40.0};
    drawContacts(image, camera, {{{0.0, 0.0, 20.0}, Vec3::UnitX(), Vec3::UnitY()}});
    for (const float value : image.values) EXPECT_EQ(value, 0.0f);
}

}  // namespace
}  // namespace scree
