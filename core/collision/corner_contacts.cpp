// Symbols: p a corner in the frame of the body whose surface it nears, n normal out of that
//          surface.
#include "core/collision/corner_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace scree {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Whether a corner of the first at p has come in through a face of the second `depth` above it:
/// then so has what it is a corner of, and halfway to that face it is still inside. A tooth that
/// cuts an edge of another by its tip lies deep under the flank as well, and leaves at once.
bool hasComeInBy(const RelativePair& pair, std::int32_t corner, const Vec3& p, const Vec3& face,
                 double depth)
{
    const Vec3 inward = pair.rotation * pair.first.features.inwardOf(corner);
    const double rises = inward.dot(face);
    return rises > 0.0 && pair.second.distance.value(p + 0.5 * depth / rises * inward) < 0.0;
}

/// The contact with the face that a corner at p stands on, whose distance is `value`.
std::optional<FeatureContact> faceStoodOn(const RelativePair& pair, std::int32_t corner,
                                          const Vec3& p, double value, double sharpness)
{
    // Corners of aligned blocks lie within rounding of several faces, of which only one can be
    // stood on, and just off an edge the shortest way to it may point anywhere. Among the faces
    // about as near take the one that has least to give way; of a corner inside, among all that it
    // may have come in by: of blocks flush with each other the nearest is the one beside. Those are
    // the ones it lies under. Beside a facet of a bent surface, a hair below the next, it is far
    // below that of which it has never been above.
    const ContactFeatures& features = pair.first.features;
    const double about = std::max(4.0 * std::abs(value), sharpness);
    const double farthest = value < 0.0 ? deepestEdges(pair) : 0.0;
    thread_local std::vector<NearFace> faces;
    faces.clear();
    pair.second.distance.facesNear(p, std::max(about, farthest), faces);
    std::optional<FeatureContact> best;
    for (const NearFace& face : faces) {
        if (best && face.height <= best->gap) continue;
        const bool isUnder = face.distance <= std::abs(face.height) + sharpness;
        if (!isUnder && face.distance > about) continue;
        if (!features.cornerSupports(corner, pair.rotation.transpose() * face.normal)) continue;
        if (face.distance > about && !hasComeInBy(pair, corner, p, face.normal, -face.height))
            continue;
        best = FeatureContact{p, face.normal, face.height};
    }
    return best;
}

}  // namespace

FacedCorner faceCorner(const RelativePair& pair, std::int32_t corner, double reach,
                       double sharpness)
{
    const SignedDistance& field = pair.second.distance;
    const ContactFeatures& features = pair.first.features;
    const Vec3 p = pair * features.points().col(corner);
    const auto supports = [&](const Vec3& n) {
        return features.cornerSupports(corner, pair.rotation.transpose() * n);
    };
    const auto between = [](double least, double most) { return FacedCorner{{}, {}, least, most}; };
    const auto apart = [&](double distance) { return between(distance, distance); };
    const auto touch = [&](const Vec3& normal, double gap) {
        return FacedCorner{FeatureContact{p, normal, gap}, {}};
    };
    const auto refuse = [&](const Vec3& normal, double gap) {
        if (gap >= 0.0) return apart(gap);
        return FacedCorner{{}, FeatureContact{p, normal, gap}};
    };
    if (pair.second.isPlane) return p.y() < reach ? touch(Vec3::UnitY(), p.y()) : apart(p.y());
    const double grid = field.gridValue(p);
    SignedDistance::Nearest nearest;
    if (field.solid() || grid <= -field.refinementBand()) {
        if (grid >= reach) return apart(grid);
        const Vec3 gradient = field.gridGradient(p), normal = gradient.normalized();
        if (!normal.allFinite()) return apart(0.0);
        if (supports(normal)) return touch(normal, grid);
        if (!field.solid() || grid >= sharpness) return refuse(normal, grid);
        nearest = {grid, p, true, gradient};
    } else if (grid >= field.refinementBand()) {
        if (grid >= reach) return between(field.lowerBound(p, grid), kInfinity);
        // Of a grid value nobody knows whether it is above or below the true distance.
        const auto seen = field.nearestFromAfar(p);
        const double gap = seen ? seen->value : field.upperBound(p);
        const Vec3 normal =
            seen ? Vec3((p - seen->point) / gap) : field.gridGradient(p).normalized();
        if (gap < reach && normal.allFinite() && supports(normal)) return touch(normal, gap);
        return between(field.lowerBound(p, grid), gap);
    } else {
        nearest = field.nearest(p);
        if (nearest.value >= reach) return apart(nearest.value);
    }
    const bool isAtEdge = !nearest.onFace && nearest.value < sharpness;
    if (!isAtEdge) {
        const Vec3 direct =
            nearest.onFace ? nearest.normal : Vec3((p - nearest.point) / nearest.value);
        if (supports(direct)) return touch(direct, nearest.value);
        if (nearest.value >= sharpness) return apart(nearest.value);  // edges meet there, if any
    }

    const std::optional<FeatureContact> best =
        faceStoodOn(pair, corner, p, nearest.value, sharpness);
    if (!best) return refuse(nearest.normal, nearest.value);
    return FacedCorner{best, {}};
}

}  // namespace scree
