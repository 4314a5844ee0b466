#include "io/plane_mesh.h"

namespace scree {

SceneMesh makePlaneMesh(const std::string& name, double halfWidth)
{
    SceneMesh square{name, Points(3, 4), Triangles(3, 2)};
    const double h = halfWidth;
    square.points << -h, -h, h, h,  //
        0, 0, 0, 0,                 //
        -h, h, h, -h;
    square.triangles << 0, 0,  //
        1, 2,                  //
        2, 3;
    return square;
}

}  // namespace scree
