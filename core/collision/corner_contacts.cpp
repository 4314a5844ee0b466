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

/// A corner of the first shape, and what may be said of it.
struct Corner {
    const RelativePair& pair;
    std::int32_t index;
    Vec3 p;

    const SignedDistance& field() const { return pair.second.distance; }

    /// Whether it can stand on a surface with this normal: what surrounds it lies above.
    bool supports(const Vec3& normal) const
    {
        return pair.first.features.cornerSupports(index, pair.rotation.transpose() * normal);
    }

    /// Whether it has come in through a face of the second `depth` above it: then so has what it is
    /// a corner of, and halfway to that face it is still inside. A tooth that cuts an edge of
    /// another by its tip lies deep under the flank as well, and leaves at once.
    bool hasComeInBy(const Vec3& face, double depth) const
    {
        const Vec3 inward = pair.rotation * pair.first.features.inwardOf(index);
        const double rises = inward.dot(face);
        return rises > 0.0 && field().value(p + 0.5 * depth / rises * inward) < 0.0;
    }

    FacedCorner touches(const Vec3& normal, double gap) const
    {
        return {FeatureContact{p, normal, gap}, {}};
    }
    static FacedCorner isBetween(double least, double most) { return {{}, {}, least, most}; }
    static FacedCorner isApart(double distance) { return isBetween(distance, distance); }

    /// It would not stand on what is nearest.
    FacedCorner isUnsupported(const Vec3& normal, double gap) const
    {
        if (gap >= 0.0) return isApart(gap);
        return {{}, FeatureContact{p, normal, gap}};
    }
};

/// The contact with the face that a corner stands on whose distance is `value`.
std::optional<FeatureContact> faceStoodOn(const Corner& corner, double value, double sharpness)
{
    // Corners of aligned blocks lie within rounding of several faces, of which only one can be
    // stood on, and just off an edge the shortest way to it may point anywhere. Among the faces
    // about as near take the one that has least to give way; of a corner inside, among all that it
    // may have come in by: of blocks flush with each other the nearest is the one beside. Those are
    // the ones it lies under. Beside a facet of a bent surface, a hair below the next, it is far
    // below that of which it has never been above.
    const double about = std::max(4.0 * std::abs(value), sharpness);
    const double farthest = value < 0.0 ? deepestEdges(corner.pair) : 0.0;
    thread_local std::vector<NearFace> faces;
    faces.clear();
    corner.field().facesNear(corner.p, std::max(about, farthest), faces);
    std::optional<FeatureContact> best;
    for (const NearFace& face : faces) {
        if (best && face.height <= best->gap) continue;
        const bool isUnder = face.distance <= std::abs(face.height) + sharpness;
        if (!isUnder && face.distance > about) continue;
        if (!corner.supports(face.normal)) continue;
        if (face.distance > about && !corner.hasComeInBy(face.normal, -face.height)) continue;
        best = FeatureContact{corner.p, face.normal, face.height};
    }
    return best;
}

/// Where the nearest place of the surface is known.
FacedCorner faceNearest(const Corner& corner, const SignedDistance::Nearest& nearest,
                        double sharpness)
{
    const bool isAtEdge = !nearest.onFace && nearest.value < sharpness;
    if (!isAtEdge) {
        const Vec3 direct =
            nearest.onFace ? nearest.normal : Vec3((corner.p - nearest.point) / nearest.value);
        if (corner.supports(direct)) return corner.touches(direct, nearest.value);
        // From here edges meet there, if any do.
        if (nearest.value >= sharpness) return Corner::isApart(nearest.value);
    }
    const std::optional<FeatureContact> best = faceStoodOn(corner, nearest.value, sharpness);
    if (!best) return corner.isUnsupported(nearest.normal, nearest.value);
    return {best, {}};
}

/// By the slope of a formula, which is exact but for its edges, or of the lattice deep inside,
/// where the way out is all that is asked.
FacedCorner faceBySlope(const Corner& corner, double value, double reach, double sharpness)
{
    if (value >= reach) return Corner::isApart(value);
    const Vec3 gradient = corner.field().gridGradient(corner.p), normal = gradient.normalized();
    if (!normal.allFinite()) return Corner::isApart(0.0);
    if (corner.supports(normal)) return corner.touches(normal, value);
    const bool mayBeAtEdge = corner.field().solid() && value < sharpness;
    if (!mayBeAtEdge) return corner.isUnsupported(normal, value);
    return faceNearest(corner, {value, corner.p, true, gradient}, sharpness);
}

/// Outside, beyond where the lattice is refined. Of its value nobody knows whether it is above or
/// below the true distance.
FacedCorner faceFromAfar(const Corner& corner, double gridValue, double reach)
{
    const SignedDistance& field = corner.field();
    if (gridValue >= reach)
        return Corner::isBetween(field.lowerBound(corner.p, gridValue), kInfinity);
    const auto seen = field.nearestFromAfar(corner.p);
    const double gap = seen ? seen->value : field.upperBound(corner.p);
    const Vec3 normal =
        seen ? Vec3((corner.p - seen->point) / gap) : field.gridGradient(corner.p).normalized();
    if (gap < reach && normal.allFinite() && corner.supports(normal))
        return corner.touches(normal, gap);
    return Corner::isBetween(field.lowerBound(corner.p, gridValue), gap);
}

}  // namespace

FacedCorner faceCorner(const RelativePair& pair, std::int32_t index, double reach, double sharpness)
{
    const Corner corner{pair, index, pair * pair.first.features.points().col(index)};
    if (pair.second.isPlane) {
        const double height = corner.p.y();
        return height < reach ? corner.touches(Vec3::UnitY(), height) : Corner::isApart(height);
    }
    const SignedDistance& field = pair.second.distance;
    const double value = field.gridValue(corner.p), band = field.refinementBand();
    if (field.solid() || value <= -band) return faceBySlope(corner, value, reach, sharpness);
    if (value >= band) return faceFromAfar(corner, value, reach);
    const SignedDistance::Nearest nearest = field.nearest(corner.p);
    if (nearest.value >= reach) return Corner::isApart(nearest.value);
    return faceNearest(corner, nearest, sharpness);
}

}  // namespace scree
