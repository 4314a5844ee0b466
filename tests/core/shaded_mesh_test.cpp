#include "core/picture/shaded_mesh.h"

#include <gtest/gtest.h>

#include "core/geometry/primitives.h"

namespace scree {
namespace {

SceneMesh sceneMesh(const TriMesh& mesh)
{
    return {"mesh", mesh.points, mesh.triangles};
}

TEST(ShadedMesh, ACubeGetsAPointPerFaceAndCorner)
{
    const ShadedMesh mesh = shadeMesh(sceneMesh(makeBox(Vec3::Ones(), {1, 1, 1})));
    EXPECT_EQ(mesh.points.size(), 24u);
    EXPECT_EQ(mesh.indices.size(), 36u);
    for (const Eigen::Vector3f& normal : mesh.normals)
        EXPECT_NEAR(normal.cwiseAbs().maxCoeff(), 1.0f, 1e-6f);
}

TEST(ShadedMesh, ASphereKeepsItsPointsAndPointsOutwards)
{
    const TriMesh sphere = makeSphere(2.0, 3);
    const ShadedMesh mesh = shadeMesh(sceneMesh(sphere));
    ASSERT_EQ(mesh.points.size(), static_cast<std::size_t>(sphere.points.cols()));
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        EXPECT_GT(mesh.normals[i].dot(mesh.points[i].normalized()), 0.999f);
}

TEST(ShadedMesh, ACylinderIsRoundAroundAndSharpAtItsRims)
{
    // 20 sides meet at 18°: one smooth side of 2 × 20 points, and two caps of a rim and a middle.
    const ShadedMesh mesh = shadeMesh(sceneMesh(makeCylinder(1.0, 2.0, 20, 1)));
    EXPECT_EQ(mesh.points.size(), 40u + 2 * 21u);
}

TEST(ShadedMesh, PointsSplitByAnExporterAreJoinedAgain)
{
    // Every triangle of a sphere with corners of its own.
    const TriMesh sphere = makeSphere(1.0, 1);
    SceneMesh soup{"soup", Points(3, 3 * sphere.triangles.cols()), sphere.triangles};
    for (int corner = 0; corner < soup.points.cols(); ++corner) {
        soup.points.col(corner) = sphere.points.col(sphere.triangles(corner % 3, corner / 3));
        soup.triangles(corner % 3, corner / 3) = corner;
    }
    EXPECT_EQ(shadeMesh(soup).points.size(), static_cast<std::size_t>(sphere.points.cols()));
}

TEST(ShadedMesh, ATriangleWithoutAreaTakesNoOthersNormals)
{
    SceneMesh mesh = sceneMesh(makeBox(Vec3::Ones(), {1, 1, 1}));
    const Eigen::Matrix3Xf whole = cornerNormals(mesh);
    const auto count = mesh.triangles.cols();
    ASSERT_EQ(whole.cols(), 3 * count);
    for (Eigen::Index corner = 0; corner < whole.cols(); ++corner) {
        const Vec3 middle =
            mesh.points(Eigen::all, mesh.triangles.col(corner / 3)).rowwise().mean();
        EXPECT_GT(whole.col(corner).cast<double>().dot(middle), 0.4) << corner;
    }
    mesh.triangles.conservativeResize(3, count + 1);
    mesh.triangles.col(count) = mesh.triangles.col(1);
    mesh.triangles.col(1) = Eigen::Vector3i::Constant(mesh.triangles(0, 0));
    const Eigen::Matrix3Xf normals = cornerNormals(mesh);
    ASSERT_EQ(normals.cols(), 3 * (count + 1));
    EXPECT_EQ(normals.leftCols(3), whole.leftCols(3));
    EXPECT_EQ(normals.middleCols(6, 3 * (count - 2)), whole.middleCols(6, 3 * (count - 2)));
    EXPECT_EQ(normals.rightCols(3), whole.middleCols(3, 3));
}

TEST(ShadedMesh, KnowsWhetherItsInsideCanBeSeen)
{
    TriMesh box = makeBox(Vec3::Ones(), {2, 2, 2});
    EXPECT_TRUE(shadeMesh(sceneMesh(box)).isClosed);
    box.triangles.conservativeResize(3, box.triangles.cols() - 1);
    EXPECT_FALSE(shadeMesh(sceneMesh(box)).isClosed);
}

TEST(ShadedMesh, ItsBallHoldsAllPoints)
{
    const TriMesh bar =
        transformed(makeBox({1, 5, 2}, {1, 1, 1}), {Vec3(7, -2, 3), Quat::Identity()});
    const ShadedMesh mesh = shadeMesh(sceneMesh(bar));
    EXPECT_NEAR(mesh.radius, 0.5 * std::sqrt(1.0 + 25.0 + 4.0), 1e-12);
    EXPECT_NEAR((mesh.centre - Vec3(7, -2, 3)).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace scree
