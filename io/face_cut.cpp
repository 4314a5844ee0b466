#include "io/face_cut.h"

#include <cstdio>

#include "core/geometry/polygon_cut.h"

namespace scree {

UncutFace::UncutFace(const Points& corners)
{
    char text[160];
    std::snprintf(text, sizeof text,
                  "a face of %d corners from (%.6g, %.6g, %.6g) on, which crosses itself or has no "
                  "area: mend it or cut it into triangles",
                  static_cast<int>(corners.cols()), corners(0, 0), corners(1, 0), corners(2, 0));
    why = text;
}

std::vector<int> cutFace(const Points& corners)
{
    std::vector<int> cut = cutPolygon(corners);
    if (cut.empty()) throw UncutFace(corners);
    return cut;
}

}  // namespace scree
