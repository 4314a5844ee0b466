// Symbols: p a corner in the frame of the body in whose crease it lies, n normal of a side.
#include "core/collision/crease_contacts.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/distance_lanes.h"

namespace scree {
namespace {

/// Cosine of the angle within which two faces are one to a corner.
constexpr double kOneFace = 0.999;

/// Of lengths, beside the size of a body.
constexpr double kRounding = 1e-7;

/// From a floor, a crease may be this many times as far as the wall beyond it: 1 / sin(bend).
const double kFartherThanSide = 1.0 / std::sqrt(1.0 - kCrease * kCrease);

/// A corner beside a crease of the second shape.
struct Beside {
    Vec3 p;
    double along;         // from the start of the crease [m]
    double squaredApart;  // from the crease [m²]
};

Beside placeBeside(const Crease& crease, const Vec3& p)
{
    const Vec3 fromStart = p - crease.start;
    const double along = crease.direction.dot(fromStart);
    const double nearest = std::clamp(along, 0.0, crease.length);
    return {p, along, (fromStart - nearest * crease.direction).squaredNorm()};
}

/// Whether what goes from p straight to the plane of a side, `height` ≥ 0 below it, meets that
/// side.
bool isBefore(const SignedDistance& field, const Crease& crease, int side, const Beside& at,
              double height, double rounding)
{
    // A side that leans back begins at the crease, before which its plane lies under the other.
    if (crease.intoFace[side].dot(at.p - crease.start) <= 0.0)
        return at.along >= -rounding && at.along <= crease.length + rounding;
    // Else the side must go on there.
    return std::abs(field.value(at.p - height * crease.faceNormal[side])) <= rounding;
}

}  // namespace

void findCreaseContacts(const RelativePair& pair, std::int32_t corner, double reach,
                        const std::optional<FeatureContact>& known,
                        std::vector<CreaseContact>& found)
{
    found.clear();
    const ContactFeatures &features = pair.first.features, &other = pair.second.features;
    if (other.creases().empty()) return;
    const Vec3 p = pair * features.points().col(corner);
    const double farthest = kFartherThanSide * reach;
    thread_local std::vector<std::pair<std::uint32_t, Beside>> near;
    near.clear();
    const FloatLanes3 place = FloatLanes3::all(p);
    const FloatLanes most =
        floatLanesOf(farthest + kSinglePrecision * (pair.second.boundingRadius + p.norm()));
    other.creaseTree().visit(
        [&](const SphereLanes& spheres) {
            const FloatLanes3 way = spheres.centre - place;
            const FloatLanes within = most + spheres.radius;
            return bitsOf(dot(way, way) <= within * within);
        },
        [&](std::uint32_t index, int) {
            const Beside at = placeBeside(other.creases()[index], p);
            if (at.squaredApart <= farthest * farthest) near.push_back({index, at});
        });
    if (near.empty()) return;
    std::ranges::sort(near, {}, &std::pair<std::uint32_t, Beside>::first);

    const SignedDistance& field = pair.second.distance;
    const double rounding = kRounding * pair.second.boundingRadius;
    // Behind the plane of a side a corner is only if it came through the crease.
    const double throughIt = rounding + std::max(0.0, -field.value(p));
    for (const auto& [index, at] : near) {
        const Crease& crease = other.creases()[index];
        for (const int side : {0, 1}) {
            const Vec3& n = crease.faceNormal[side];
            const auto isOne = [&](const FeatureContact& c) { return c.normal.dot(n) > kOneFace; };
            if (std::any_of(found.begin(), found.end(),
                            [&](const CreaseContact& c) { return isOne(c.contact); })) {
                continue;
            }
            const auto id = static_cast<std::int32_t>(2 * index) + side;
            if (known && isOne(*known)) {
                found.push_back({*known, id});
                continue;
            }
            const double height = n.dot(p - crease.start);
            if (height >= reach) continue;
            if (height < 0.0 && at.squaredApart > throughIt * throughIt) continue;
            if (!features.cornerSupports(corner, pair.rotation.transpose() * n)) continue;
            if (height >= 0.0 && !isBefore(field, crease, side, at, height, rounding)) continue;
            found.push_back({FeatureContact{p, n, height}, id});
        }
    }
}

}  // namespace scree
