#include "render/image.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

namespace scree {
namespace {

std::uint8_t encodeSrgb(float linear)
{
    Image image(1, 1);
    image.set(0, 0, Color::Constant(linear));
    return toSrgbBytes(image).front();
}

float decodeSrgb(std::uint8_t encoded)
{
    const std::array pixel = {encoded, encoded, encoded};
    return fromSrgbBytes(1, 1, pixel).values.front();
}

TEST(Srgb, EndsAreExactAndOutsideIsClamped)
{
    EXPECT_EQ(encodeSrgb(0.0f), 0);
    EXPECT_EQ(encodeSrgb(1.0f), 255);
    EXPECT_EQ(encodeSrgb(-3.0f), 0);
    EXPECT_EQ(encodeSrgb(7.0f), 255);
    EXPECT_EQ(encodeSrgb(std::nanf("")), 0);
    EXPECT_EQ(decodeSrgb(0), 0.0f);
    EXPECT_EQ(decodeSrgb(255), 1.0f);
}

TEST(Srgb, MiddleGreyIsWhereTheStandardPutsIt)
{
    // The curve of IEC 61966-2-1 worked out by hand: 0.5 → 0.735357 → 187.5, 0.18 → 0.461356 →
    // 117.6; byte 128 → 0.215861; and one value on the straight part: 0.002 → 0.02584 → 6.6.
    EXPECT_EQ(encodeSrgb(0.5f), 188);
    EXPECT_EQ(encodeSrgb(0.18f), 118);
    EXPECT_EQ(encodeSrgb(0.002f), 7);
    EXPECT_NEAR(decodeSrgb(128), 0.215861f, 1e-6f);
}

TEST(Srgb, EveryByteSurvivesDecodingAndEncoding)
{
    for (int byte = 0; byte < 256; ++byte)
        EXPECT_EQ(encodeSrgb(decodeSrgb(static_cast<std::uint8_t>(byte))), byte);
}

TEST(Srgb, RoundsToTheNearestByteEverywhere)
{
    for (int i = 0; i <= 100000; ++i) {
        const float linear = static_cast<float>(i) / 100000.0f;
        const double x = linear;
        const double exact =
            255.0 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055);
        // The two branches of the standard's curve meet only to within 1e-5 of a byte or so.
        EXPECT_NEAR(encodeSrgb(linear), exact, 0.5001) << linear;
    }
}

TEST(Image, DownscalingAveragesLightNotBytes)
{
    Image image(2, 2, Color::Zero());
    image.set(0, 0, Color::Ones());
    image.set(1, 1, Color::Ones());
    const Image small = downscaled(image, 1, 1);
    EXPECT_NEAR(small.at(0, 0).x(), 0.5f, 1e-6f);
    EXPECT_EQ(toSrgbBytes(small).front(), 188);
}

TEST(Image, DownscalingByAFractionWeighsPixelsByTheirArea)
{
    Image image(3, 1, Color::Zero());
    image.set(1, 0, Color(1.0f, 0.0f, 0.0f));
    const Image small = downscaled(image, 2, 1);  // each new pixel covers one and a half
    EXPECT_NEAR(small.at(0, 0).x(), 1.0f / 3.0f, 1e-6f);
    EXPECT_NEAR(small.at(1, 0).x(), 1.0f / 3.0f, 1e-6f);
}

TEST(Image, PastingDropsWhatHangsOver)
{
    Image target(4, 4, Color::Zero());
    paste(target, Image(3, 3, Color::Ones()), 2, -1);
    float sum = 0.0f;
    for (const float value : target.values) sum += value;
    EXPECT_EQ(sum, 3.0f * 4);  // two columns, two rows
    EXPECT_EQ(target.at(2, 0).x(), 1.0f);
    EXPECT_EQ(target.at(3, 1).x(), 1.0f);
    EXPECT_EQ(target.at(2, 2).x(), 0.0f);
}

}  // namespace
}  // namespace scree
