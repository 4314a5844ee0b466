#include "core/geometry/polygon_cut.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/math/rotation.h"
#include "tests/support/draw.h"

namespace scree::test {
namespace {

Points flat(std::initializer_list<std::array<double, 2>> places)
{
    Points corners = Points::Zero(3, static_cast<Eigen::Index>(places.size()));
    Eigen::Index k = 0;
    for (const auto& [x, y] : places) corners.col(k++) << x, y, 0.0;
    return corners;
}

Vec3 areaOf(const Vec3& a, const Vec3& b, const Vec3& c)
{
    return 0.5 * (b - a).cross(c - a);
}

/// By the corners alone.
Vec3 areaOf(const Points& corners)
{
    Vec3 area = Vec3::Zero();
    for (Eigen::Index k = 1; k + 1 < corners.cols(); ++k)
        area += areaOf(corners.col(0), corners.col(k), corners.col(k + 1));
    return area;
}

/// Triangles that all turn as the polygon does and have its area together fill it. `least`: of each
/// [m²].
void expectFilled(const Points& corners, double least)
{
    const std::vector<int> cut = cutPolygon(corners);
    ASSERT_EQ(cut.size(), 3 * static_cast<std::size_t>(corners.cols() - 2));
    const Vec3 whole = areaOf(corners), normal = whole.normalized();
    double sum = 0.0;
    for (std::size_t k = 0; k < cut.size(); k += 3) {
        const double area =
            areaOf(corners.col(cut[k]), corners.col(cut[k + 1]), corners.col(cut[k + 2]))
                .dot(normal);
        EXPECT_GE(area, least);
        sum += area;
    }
    EXPECT_NEAR(sum, whole.norm(), 1e-12 * whole.norm());
}

// Happened: the inner corner of an L with arms of one length lies on the line between two others,
// and a triangle went over it and covered the notch.
TEST(CutPolygon, FillsLettersAndStairsWhereverTheyBegin)
{
    const Points ell = flat({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}});
    const Points stairs =
        flat({{0, 0}, {4, 0}, {4, 1}, {3, 1}, {3, 2}, {2, 2}, {2, 3}, {1, 3}, {1, 4}, {0, 4}});
    for (const Points& shape : {ell, stairs}) {
        for (Eigen::Index first = 0; first < shape.cols(); ++first) {
            Points turned(3, shape.cols());
            for (Eigen::Index k = 0; k < shape.cols(); ++k)
                turned.col(k) = shape.col((first + k) % shape.cols());
            expectFilled(turned, 0.5);
            expectFilled(turned.rowwise().reverse(), 0.5);
            const Mat3 axes = (Mat3() << 0, 0, 1, 1, 0, 0, 0, 1, 0).finished();
            expectFilled(axes * turned, 0.5);
            expectFilled(axes * axes * turned, 0.5);
        }
    }
}

TEST(CutPolygon, GivesAConvexOneAsAFanAroundItsFirstCorner)
{
    EXPECT_EQ(cutPolygon(flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}})),
              (std::vector<int>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(cutPolygon(flat({{0, 0}, {2, 0}, {3, 1}, {2, 2}, {0, 2}})),
              (std::vector<int>{0, 1, 2, 0, 2, 3, 0, 3, 4}));
}

TEST(CutPolygon, LeavesNoTriangleFlatWhereCornersLieOnALine)
{
    expectFilled(flat({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {1, 2}}), 0.9);
    expectFilled(flat({{0, 0}, {1, 0}, {2, 0}, {1, 1}, {0, 2}, {0, 1}}), 0.4);
}

TEST(CutPolygon, GoesAroundAHoleThatASlitLeadsTo)
{
    expectFilled(
        flat({{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}}),
        0.4);
}

TEST(CutPolygon, FillsStarsOfAnyPlane)
{
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const int count = 4 + static_cast<int>(seed % 40);
        Points star(3, count);
        for (int k = 0; k < count; ++k) {
            const double angle = 2.0 * kPi * k / count;
            const double radius = 1.5 + signedUnit(seed, static_cast<std::uint64_t>(k));
            star.col(k) << radius * std::cos(angle), radius * std::sin(angle), 0.0;
        }
        expectFilled(exponentialMap(3.0 * signedUnits(seed, 1000)) * star, 1e-9);
    }
}

TEST(CutPolygon, AnswersNothingForWhatCrossesItselfOrHasNoArea)
{
    EXPECT_TRUE(cutPolygon(flat({{0, 0}, {1, 1}, {1, 0}, {0, 1}})).empty());
    EXPECT_TRUE(cutPolygon(flat({{0, 0}, {1, 0}, {2, 0}, {3, 0}})).empty());
    EXPECT_TRUE(cutPolygon(flat({{0, 0}, {4, 0}, {4, 1}, {0, 1}, {3, 2}, {3, -1}})).empty());
    EXPECT_TRUE(cutPolygon(Points::Constant(3, 5, 0.25)).empty());
}

// A triangle of three corners on one line, rounded to single precision, faced anywhere.
TEST(CutPolygon, TakesCornersOnALineForThatAfterRounding)
{
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const Points sides = flat({{0, 0}, {0.7, 0}, {2, 0}, {2, 0.3}, {2, 1}, {1.1, 1}, {0, 1}});
        const Mat3 turned = exponentialMap(3.0 * signedUnits(seed, 1000)).toRotationMatrix();
        const Points corners =
            ((turned * sides).colwise() + signedUnits(seed, 2000)).cast<float>().cast<double>();
        const Vec3 normal = turned * Vec3::UnitZ();
        const std::vector<int> cut = cutPolygon(corners);
        ASSERT_EQ(cut.size(), 15u);
        for (std::size_t k = 0; k < cut.size(); k += 3) {
            const Vec3 area =
                areaOf(corners.col(cut[k]), corners.col(cut[k + 1]), corners.col(cut[k + 2]));
            EXPECT_GT(area.normalized().dot(normal), 0.9999) << seed;
        }
    }
}

}  // namespace
}  // namespace scree::test
