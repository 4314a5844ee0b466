// Symbols: phi signed distance, h edge of the cells that are summed.
#include "core/geometry/shape_report.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/geometry/mesh_defects.h"
#include "core/math/rotation.h"

namespace scree {
namespace {

constexpr double kMostCells = 128.0;  // along the longest edge

/// Sums cells, each by the share of it that lies below the surface.
double fieldVolume(const Shape& shape)
{
    const Aabb box = shape.box;
    const double h = std::max(shape.distance.spacing(), box.longestEdge() / kMostCells);
    const auto cells = [&](int k) { return static_cast<int>(std::ceil(box.size()[k] / h)) + 2; };
    const Vec3 first = box.min - Vec3::Constant(0.5 * h);
    std::vector<double> slices(cells(2), 0.0);
    parallelFor(slices.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            for (int j = 0; j < cells(1); ++j) {
                for (int i = 0; i < cells(0); ++i) {
                    const Vec3 p = first + h * Vec3(i, j, static_cast<double>(k));
                    const double phi = shape.distance.gridValue(p);
                    slices[k] += std::clamp(0.5 - phi / h, 0.0, 1.0);
                }
            }
        }
    });
    double sum = 0.0;
    for (const double slice : slices) sum += slice;
    return sum * h * h * h;
}

}  // namespace

ShapeReport reportShape(const Shape& shape)
{
    ShapeReport report;
    report.triangles = shape.mesh.triangles.cols();
    report.points = shape.mesh.points.cols();
    const std::vector<int> partOf = findParts(shape.mesh);
    report.parts = 1 + *std::max_element(partOf.begin(), partOf.end());
    report.meshVolume = shape.unitMass.volume;
    report.fieldVolume = fieldVolume(shape);
    report.sharpestEdge = sharpestEdge(shape.mesh);
    report.sharpEdges = countSharperEdges(shape.mesh, kSharpEdge);
    report.longestEdge = shape.box.longestEdge();
    return report;
}

}  // namespace scree
