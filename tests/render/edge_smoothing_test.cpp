#include "render/edge_smoothing.h"

#include <cmath>

#include <gtest/gtest.h>

namespace scree {
namespace {

constexpr int kSize = 64;

/// White below the line y = height + slope · x, black above; pixels are all or nothing.
Image halfPlane(double height, double slope)
{
    Image image(kSize, kSize);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            if (y + 0.5 > height + slope * (x + 0.5)) image.set(x, y, Color::Ones());
    return image;
}

/// The share of the pixel below the line, by 32 × 32 points.
double coverage(double height, double slope, int x, int y)
{
    int inside = 0;
    for (int i = 0; i < 32; ++i)
        for (int k = 0; k < 32; ++k)
            inside += y + (k + 0.5) / 32 > height + slope * (x + (i + 0.5) / 32);
    return inside / 1024.0;
}

/// Sum over the pixels of how far they are from the exact coverage, away from the border.
double error(const Image& image, double height, double slope)
{
    double sum = 0.0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 10; x < kSize - 10; ++x)
            sum += std::abs(image.at(x, y).x() - coverage(height, slope, x, y));
    return sum;
}

TEST(EdgeSmoothing, StraightEdgesComeCloseToTheirExactCoverage)
{
    for (const double slope : {0.11, 0.23, -0.37, 0.5, -0.71}) {
        const Image stairs = halfPlane(32.0 - 32.0 * slope, slope);
        Image smooth = stairs;
        smoothEdges(smooth);
        // Stairs are wrong by a quarter of a pixel for every pixel of the edge; what is left of
        // that comes from runs of uneven length and from steps that tell little of the way between
        // them.
        EXPECT_LT(error(smooth, 32.0 - 32.0 * slope, slope),
                  0.65 * error(stairs, 32.0 - 32.0 * slope, slope))
            << slope;
    }
}

TEST(EdgeSmoothing, LevelEdgesAndCornersStayAsTheyAre)
{
    Image image = halfPlane(20.0, 0.0);
    for (int y = 30; y < 50; ++y) image.set(40, y, Color(0.5f, 0.1f, 0.1f));
    for (int y = 30; y < 50; ++y) image.set(41, y, Color(0.5f, 0.1f, 0.1f));
    Image smooth = halfPlane(20.0, 0.0);
    smoothEdges(smooth);
    EXPECT_EQ(smooth.values, halfPlane(20.0, 0.0).values);
    smooth = image;
    smoothEdges(smooth);
    EXPECT_EQ(smooth.values, image.values);  // a bar has corners, no stairs
}

TEST(EdgeSmoothing, RowsAndColumnsAreTreatedAlike)
{
    const Image image = halfPlane(20.0, 0.31);
    Image turned(kSize, kSize);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) turned.set(y, x, image.at(x, y));
    Image a = image, b = turned;
    smoothEdges(a);
    smoothEdges(b);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) EXPECT_NEAR(a.at(x, y).x(), b.at(y, x).x(), 1e-6f);
}

}  // namespace
}  // namespace scree
