#include "tools/bones/funnel.h"

#include <array>
#include <cmath>
#include <numbers>

namespace scree {
namespace {

constexpr int kSectors = 48;

/// Radius and height of the profile, counter-clockwise with the axis on its left [m]: down the
/// inside, up the outside. The outlet is 1.4 m wide, and the longest bone reaches 0.85 m; the wall
/// is 0.3 m thick and slopes by 45 degrees.
constexpr std::array<std::array<double, 2>, 8> kProfile = {{{2.9, 2.55},
                                                            {2.9, 2.2},
                                                            {1.8, 1.1},
                                                            {0.7, 0.0},
                                                            {1.0, -0.124},
                                                            {2.1, 0.976},
                                                            {3.2, 2.076},
                                                            {3.2, 2.55}}};

}  // namespace

TriMesh makeFunnel()
{
    constexpr int kRings = static_cast<int>(kProfile.size());
    TriMesh mesh;
    mesh.points.resize(3, kSectors * kRings);
    mesh.triangles.resize(3, 2 * kSectors * kRings);
    for (int s = 0; s < kSectors; ++s) {
        const double angle = 2.0 * std::numbers::pi * s / kSectors;
        for (int r = 0; r < kRings; ++r) {
            const auto [radius, height] = kProfile[r];
            mesh.points.col(s * kRings + r) =
                Vec3(radius * std::cos(angle), height, radius * std::sin(angle));
            const int sNext = (s + 1) % kSectors, rNext = (r + 1) % kRings;
            const int a = s * kRings + r, b = sNext * kRings + r, c = sNext * kRings + rNext,
                      d = s * kRings + rNext;
            mesh.triangles.col(2 * (s * kRings + r)) << a, c, b;
            mesh.triangles.col(2 * (s * kRings + r) + 1) << a, d, c;
        }
    }
    return mesh;
}

}  // namespace scree
