#include "io/plane_mesh.h"

#include <algorithm>

namespace scree {
namespace {

/// No cache could hold a larger one: then the body that is so far away is to be named.
constexpr double kLargestHalfWidth = 1e38;

}  // namespace

SceneMesh makePlaneMesh(const std::string& name, double halfWidth)
{
    SceneMesh square{
        .name = name, .points = Points(3, 4), .triangles = Triangles(3, 2), .isPlane = true};
    const double h = std::min(halfWidth, kLargestHalfWidth);
    square.points << -h, -h, h, h,  //
        0, 0, 0, 0,                 //
        -h, h, h, -h;
    square.triangles << 0, 0,  //
        1, 2,                  //
        2, 3;
    return square;
}

}  // namespace scree
