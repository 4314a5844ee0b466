#include "render/contact_sheet.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "render/text.h"

namespace scree {
namespace {

constexpr SheetLayout kLayout = {2, 80, 6, 1};  // columns, cell width, gap, label scale

Color hue(int i)
{
    return {0.2f + 0.1f * static_cast<float>(i), i % 2 ? 0.9f : 0.1f, 0.3f};
}

std::vector<LabelledImage> pictures(int count)
{
    std::vector<LabelledImage> result;
    for (int i = 0; i < count; ++i) result.push_back({Image(160, 90, hue(i)), "frame"});
    return result;
}

int inkCount(const Image& image, int x, int y, int width, int height)
{
    int count = 0;
    for (int row = y; row < y + height; ++row)
        for (int column = x; column < x + width; ++column)
            if (image.at(column, row).x() > 0.3f) ++count;
    return count;
}

TEST(ContactSheet, PicturesStandInReadingOrder)
{
    const Image sheet = makeContactSheet(pictures(3), kLayout);
    const int pitchX = 80 + 6, pitchY = 45 + kTextHeight + 3 + 6;
    EXPECT_EQ(sheet.width, 2 * pitchX + 6);
    EXPECT_EQ(sheet.height, 2 * pitchY + 6);
    for (int i = 0; i < 3; ++i) {
        const int x = 6 + i % 2 * pitchX, y = 6 + i / 2 * pitchY;
        EXPECT_TRUE(sheet.at(x, y).isApprox(hue(i), 1e-5f)) << i;
        EXPECT_TRUE(sheet.at(x + 79, y + 44).isApprox(hue(i), 1e-5f)) << i;
    }
    EXPECT_LT(sheet.at(6 + pitchX + 40, 6 + pitchY + 20).maxCoeff(), 0.1f);  // the empty cell
}

TEST(ContactSheet, LabelsAreWrittenBelowTheirPictures)
{
    auto labelled = pictures(2);
    labelled[1].label.clear();
    const Image sheet = makeContactSheet(labelled, kLayout);
    EXPECT_GT(inkCount(sheet, 6, 6 + 45 + 3, 80, kTextHeight), 30);
    EXPECT_EQ(inkCount(sheet, 6 + 86, 6 + 45 + 3, 80, kTextHeight), 0);
}

TEST(ContactSheet, SmallPicturesAreNotEnlargedAndLongLabelsDoNotRunOver)
{
    const std::vector<LabelledImage> small = {{Image(40, 40, hue(0)), "a_very_long_label_1001"},
                                              {Image(40, 40, hue(1)), ""}};
    const Image sheet = makeContactSheet(small, kLayout);
    EXPECT_EQ(sheet.width, 2 * 46 + 6);
    EXPECT_EQ(inkCount(sheet, 46, 6 + 40, 52, sheet.height - 46), 0);
}

TEST(ContactSheet, WithoutPicturesIsAnError)
{
    EXPECT_THROW(makeContactSheet({}, kLayout), Error);
}

TEST(Text, AGlyphIsDrawnDotByDot)
{
    Image image(6, kTextHeight, Color::Zero());
    drawText(image, 0, 0, 1, "T", Color::Ones());
    EXPECT_EQ(inkCount(image, 0, 0, 6, kTextHeight), 5 + 6);
    EXPECT_EQ(inkCount(image, 0, 0, 5, 1), 5);
    EXPECT_EQ(inkCount(image, 2, 0, 1, 7), 7);
}

TEST(Text, AllPrintableCharactersDiffer)
{
    std::vector<std::vector<float>> seen;
    for (char c = ' '; c <= '~'; ++c) {
        Image image(5, kTextHeight, Color::Zero());
        drawText(image, 0, 0, 1, std::string(1, c), Color::Ones());
        for (const auto& other : seen) EXPECT_NE(image.values, other) << c;
        seen.push_back(image.values);
    }
}

TEST(Text, BurnInStaysInTheLowerLeftCorner)
{
    const Image before(640, 360, Color::Constant(0.2f));
    Image after = before;
    burnIn(after, "frame 1001");
    EXPECT_GT(inkCount(after, 0, 330, 200, 30), 50);
    for (int x = 0; x < 640; ++x) EXPECT_EQ(after.at(x, 300), before.at(x, 300));
    EXPECT_EQ(after.at(600, 359), before.at(600, 359));
}

}  // namespace
}  // namespace scree
