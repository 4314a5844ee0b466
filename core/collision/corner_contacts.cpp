// Symbols: p a corner in the frame of the body whose surface it nears.
#include "core/collision/corner_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace scree {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A corner of the first shape, at p in the frame of the second, and the answers there are.
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

    FacedCorner touching(const Vec3& normal, double gap) const
    {
        return {FeatureContact{p, normal, gap}, {}};
    }
    static FacedCorner between(double least, double most) { return {{}, {}, least, most}; }
    static FacedCorner apart(double distance) { return between(distance, distance); }

    /// Where it cannot stand on what is nearest.
    FacedCorner unsupported(const Vec3& normal, double gap) const
    {
        if (gap >= 0.0) return apart(gap);
        return {{}, FeatureContact{p, normal, gap}};
    }
};

/// The contact with the face that a corner stands on; `value` is its distance from the surface.
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
        if (corner.supports(direct)) return corner.touching(direct, nearest.value);
        // From here edges meet there, if any do.
        if (nearest.value >= sharpness) return Corner::apart(nearest.value);
    }
    const std::optional<FeatureContact> best = faceStoodOn(corner, nearest.value, sharpness);
    if (!best) return corner.unsupported(nearest.normal, nearest.value);
    return {best, {}};
}

/// By the slope of a formula, which is exact but for its edges, or of the lattice deep inside,
/// where the way out is all that is asked.
FacedCorner faceBySlope(const Corner& corner, double value, double reach, double sharpness)
{
    if (value >= reach) return Corner::apart(value);
    const Vec3 gradient = corner.field().gridGradient(corner.p), normal = gradient.normalized();
    if (normal.isZero(0.0)) return Corner::apart(0.0);  // as far from all sides
    if (corner.supports(normal)) return corner.touching(normal, value);
    const bool mayBeAtEdge = corner.field().solid() && value < sharpness;
    if (!mayBeAtEdge) return corner.unsupported(normal, value);
    return faceNearest(corner, {value, corner.p, true, gradient}, sharpness);
}

/// Outside, beyond where the lattice is refined. Of its value nobody knows whether it is above or
/// below the true distance.
FacedCorner faceFromAfar(const Corner& corner, double gridValue, double reach)
{
    const SignedDistance& field = corner.field();
    if (gridValue >= reach)
        return Corner::between(field.lowerBound(corner.p, gridValue), kInfinity);
    const auto seen = field.nearestFromAfar(corner.p);
    const double gap = seen ? seen->value : field.upperBound(corner.p);
    const Vec3 normal =
        seen ? Vec3((corner.p - seen->point) / gap) : field.gridGradient(corner.p).normalized();
    if (gap < reach && !normal.isZero(0.0) && corner.supports(normal))
        return corner.touching(normal, gap);
    return Corner::between(field.lowerBound(corner.p, gridValue), gap);
}

}  // namespace

FacedCorner faceCorner(const RelativePair& pair, std::int32_t index, double reach, double sharpness)
{
    const Corner corner{pair, index, pair * pair.first.features.points().col(index)};
    if (pair.second.isPlane) {
        const double height = corner.p.y();
        return height < reach ? corner.touching(Vec3::UnitY(), height) : Corner::apart(height);
    }
    const SignedDistance& field = pair.second.distance;
    const double value = field.gridValue(corner.p), band = field.refinementBand();
    if (field.solid() || value <= -band) return faceBySlope(corner, value, reach, sharpness);
    if (value >= band) return faceFromAfar(corner, value, reach);
    const SignedDistance::Nearest nearest = field.nearest(corner.p);
    if (nearest.value >= reach) return Corner::apart(nearest.value);
    return faceNearest(corner, nearest, sharpness);
}

}  // namespace scree
