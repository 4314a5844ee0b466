// The order of drawing; depth_map.h tells which bodies are hidden.
#include "render/hidden_bodies.h"

#include <algorithm>

namespace scree {
namespace {

Mat4 matrixOf(const Pose& pose)
{
    Mat4 matrix = Mat4::Identity();
    matrix.topLeftCorner<3, 3>() = pose.orientation.toRotationMatrix();
    matrix.topRightCorner<3, 1>() = pose.position;
    return matrix;
}

}  // namespace

std::vector<std::size_t> drawNearToFar(DepthMap& map, const std::vector<PlacedMesh>& bodies,
                                       const std::vector<Ball>& balls, const Mat4& clipFromWorld,
                                       double slopeBias)
{
    // Depth and the last row of a camera's projection change along the same direction, so that
    // their bounds belong to the same point of the ball.
    std::vector<std::pair<double, std::size_t>> nearToFar;
    std::vector<std::size_t> seen;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Eigen::Vector4d middle =
            clipFromWorld.leftCols<3>() * balls[i].centre + clipFromWorld.col(3);
        const Eigen::Vector4d reach =
            balls[i].radius * clipFromWorld.leftCols<3>().rowwise().norm();
        const double nearW = middle.w() - reach.w();
        if (nearW > 0.0)
            nearToFar.emplace_back((middle.z() - reach.z()) / nearW, i);
        else
            seen.push_back(i);
    }
    std::sort(nearToFar.begin(), nearToFar.end());
    for (const auto& [depth, i] : nearToFar)
        if (drawDepths(map, *bodies[i].mesh, clipFromWorld * matrixOf(bodies[i].worldFromAsset),
                       slopeBias))
            seen.push_back(i);
    return seen;
}

PictureMap mapOfPicture(const Mat4& clipFromWorld, int width, int height)
{
    PictureMap map;
    map.size = std::max({width, height, kFewestMapTexels});
    Mat4 mapFromPicture = Mat4::Identity();
    mapFromPicture(0, 0) = static_cast<double>(width) / map.size;
    mapFromPicture(1, 1) = static_cast<double>(height) / map.size;
    mapFromPicture(0, 3) = mapFromPicture(0, 0) - 1.0;
    mapFromPicture(1, 3) = mapFromPicture(1, 1) - 1.0;
    map.clipFromWorld = mapFromPicture * clipFromWorld;
    return map;
}

}  // namespace scree
