#include "tools/bones/funnel.h"

#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

namespace scree {
namespace {

constexpr int kSectors = 48;

/// Radius and height of the profile, counter-clockwise with the axis on its left [m]: down the
/// inside, up the outside. The outlet is 3 m wide, and the longest bone reaches 0.85 m: half as
/// wide it jams as soon as the columns arrive, and bones leap over the rim. The collar takes all
/// that columns of 1 m about 1.75 m from the axis drop. The wall is 0.3 m thick.
using Profile = std::array<std::array<double, 2>, 8>;

constexpr Profile kOutline = {{{3.4, 3.4},
                               {3.4, 2.4},
                               {2.45, 1.2},
                               {1.5, 0.0},
                               {1.735, -0.186},
                               {2.685, 1.014},
                               {3.7, 2.296},
                               {3.7, 3.4}}};

}  // namespace

TriMesh makeFunnel()
{
    constexpr int kRings = static_cast<int>(std::tuple_size_v<Profile>);
    TriMesh mesh;
    mesh.points.resize(3, kSectors * kRings);
    mesh.triangles.resize(3, 2 * kSectors * kRings);
    for (int s = 0; s < kSectors; ++s) {
        const double angle = 2.0 * std::numbers::pi * s / kSectors;
        for (int r = 0; r < kRings; ++r) {
            const auto [radius, height] = kOutline[r];
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
