// Symbols: p a corner in the frame of the body whose surface it nears, q the closest point there,
//          n normal out of that surface, d unit direction of an edge.
#include "core/collision/near_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace scree {
namespace {

/// How much farther than asked a look reaches, so that it need not be repeated at once. Only time
/// depends on it.
constexpr double kLookAhead = 1.0;        // times the reach
constexpr double kLeastLookAhead = 0.01;  // times the bounding radius of the smaller body

/// Edges closer to parallel than this meet nowhere in particular: their ends speak for them [-].
constexpr double kParallel = 1e-3;

/// Edges deeper in each other than this share of the thinner wall are not what touches: in a deep
/// overlap every far edge "interferes", and the corners inside tell the way out.
constexpr double kDeepestEdges = 0.25;

/// Nearer to an edge or corner than this share of the smaller body, the faces beside it decide the
/// normal: an edge is no sharper than that.
constexpr double kSharpness = 1e-3;

/// Contacts nearer to each other than this share of the smaller body, with normals as close, are
/// one.
constexpr double kSamePlace = 5e-3;

enum class Kind : std::uint64_t { cornerOfA = 0, cornerOfB = 1, edges = 2, ball = 3 };

std::uint64_t featureId(Kind kind, std::int32_t first, std::int32_t second = 0)
{
    return static_cast<std::uint64_t>(kind) << 62 | static_cast<std::uint64_t>(first) << 31 |
           static_cast<std::uint64_t>(second);
}

bool isBall(const Shape& shape)
{
    const ExactSolid* solid = shape.distance.solid();
    return solid && solid->form() == ExactSolid::Form::sphere;
}

double smallerRadius(const PlacedPair& pair)
{
    double smaller = std::numeric_limits<double>::infinity();
    for (const Shape* shape : {pair.shapeA, pair.shapeB}) {
        if (!shape->isPlane) smaller = std::min(smaller, shape->boundingRadius);
    }
    return smaller;
}

/// The body that lends corners, seen from the other.
struct Corners {
    const Shape& corners;
    const Shape& surface;
    Mat3 rotation;  // surface from corners
    Vec3 translation;
};

struct SurfaceContact {
    Vec3 normal;  // out of the surface, its frame
    double gap;
};

/// How a corner at p faces the surface; none when its surroundings would have to pass through it.
std::optional<SurfaceContact> facing(const Corners& way, std::int32_t corner, const Vec3& p,
                                     double reach, double sharpness, SurfaceContact& unsupported)
{
    const SignedDistance& field = way.surface.distance;
    const auto supports = [&](const Vec3& n) {
        return way.corners.features.cornerSupports(corner, way.rotation.transpose() * n);
    };
    if (way.surface.isPlane) {
        if (p.y() >= reach) return {};
        return SurfaceContact{Vec3::UnitY(), p.y()};
    }
    const double grid = field.gridValue(p);
    if (field.solid() || std::abs(grid) >= field.refinementBand()) {
        if (grid >= reach) return {};
        const SurfaceContact far{field.gridGradient(p).normalized(), grid};
        if (!far.normal.allFinite()) return {};
        if (supports(far.normal)) return far;
        if (!field.solid() || grid >= sharpness) {
            unsupported = far;
            return {};
        }
    }
    const SignedDistance::Nearest nearest =
        field.solid() ? SignedDistance::Nearest{grid, p, true, field.gridGradient(p)}
                      : field.nearest(p);
    if (nearest.value >= reach) return {};
    const bool isAtEdge = !nearest.onFace && nearest.value < sharpness;
    if (!isAtEdge) {
        const SurfaceContact direct{
            nearest.onFace ? nearest.normal : Vec3((p - nearest.point) / nearest.value),
            nearest.value};
        if (supports(direct.normal)) return direct;
        if (nearest.value >= sharpness) return {};  // it passes beside: edges meet there, if any
    }

    // Corners of aligned blocks lie within rounding of several faces, of which only one can be
    // stood on, and just off an edge the shortest way to it may point anywhere. Among the faces
    // about as near take the one that has least to give way.
    thread_local std::vector<NearFace> faces;
    faces.clear();
    field.facesNear(p, std::max(4.0 * std::abs(nearest.value), sharpness), faces);
    std::optional<SurfaceContact> best;
    for (const NearFace& face : faces) {
        if (best && face.height <= best->gap) continue;
        if (supports(face.normal)) best = SurfaceContact{face.normal, face.height};
    }
    if (!best) unsupported = {nearest.normal, nearest.value};
    return best;
}

/// Where the lines of two edges are closest, inside both; in the frame of B.
struct Crossing {
    Vec3 onA, onB, normal;  // normal not oriented
};

std::optional<Crossing> crossing(const Vec3& startA, const Vec3& dA, double lengthA,
                                 const Vec3& startB, const Vec3& dB, double lengthB)
{
    const double cosine = dA.dot(dB);
    const double sineSquared = 1.0 - cosine * cosine;
    if (sineSquared < kParallel * kParallel) return {};
    const Vec3 between = startA - startB;
    const double alongA = dA.dot(between), alongB = dB.dot(between);
    const double s = (cosine * alongB - alongA) / sineSquared;
    if (s < 0.0 || s > lengthA) return {};
    const double t = (alongB - cosine * alongA) / sineSquared;
    if (t < 0.0 || t > lengthB) return {};
    return Crossing{startA + s * dA, startB + t * dB, dA.cross(dB).normalized()};
}

struct EdgeContact {
    Vec3 onA, normal;  // frame of B
    double gap;
};

std::optional<EdgeContact> facing(const PlacedPair& pair, const Mat3& rotation,
                                  const Vec3& translation, std::int32_t ofA, std::int32_t ofB,
                                  double reach, double sharpness)
{
    const ConvexEdge& a = pair.shapeA->features.edges()[ofA];
    const ConvexEdge& b = pair.shapeB->features.edges()[ofB];
    const std::optional<Crossing> at =
        crossing(rotation * a.start + translation, rotation * a.direction, a.length, b.start,
                 b.direction, b.length);
    if (!at) return {};
    const Vec3 outward = b.faceNormal[0] + b.faceNormal[1];
    const Vec3 n = at->normal.dot(outward) >= 0.0 ? at->normal : Vec3(-at->normal);
    const double gap = n.dot(at->onA - at->onB);
    if (gap >= reach) return {};
    if (!edgeSupports(b, -n) || !edgeSupports(a, rotation.transpose() * n)) return {};
    if (gap >= -sharpness) return EdgeContact{at->onA, n, gap};

    // Two edges of solids that overlap elsewhere may pass each other anywhere inside. If these are
    // what overlaps, A's edge is about as deep in B as the faces beside B's edge make it.
    const double deepest =
        kDeepestEdges * std::min(pair.shapeA->innerThickness, pair.shapeB->innerThickness);
    if (gap < -deepest) return {};
    const double expected = gap * std::max(n.dot(b.faceNormal[0]), n.dot(b.faceNormal[1]));
    if (pair.shapeB->distance.value(at->onA) > 0.5 * expected) return {};
    return EdgeContact{at->onA, n, gap};
}

/// Distance between two segments is at least this.
double apartAtLeast(const Vec3& middleA, double halfA, const Vec3& middleB, double halfB)
{
    return (middleA - middleB).norm() - halfA - halfB;
}

}  // namespace

void NearFeatures::lookAgain(const PlacedPair& pair, const Mat3& rotation, const Vec3& translation)
{
    isKnown_ = true;
    rotation_ = rotation;
    translation_ = translation;
    cornersOfA_.clear();
    cornersOfB_.clear();
    edges_.clear();

    const Shape& shapeA = *pair.shapeA;
    const Shape& shapeB = *pair.shapeB;
    const Mat3 back = rotation.transpose();
    const Corners ways[2] = {{shapeA, shapeB, rotation, translation},
                             {shapeB, shapeA, back, -(back * translation)}};
    thread_local std::vector<std::int32_t> nearEdges[2];
    for (int side = 0; side < 2; ++side) {
        const Corners& way = ways[side];
        const SignedDistance& field = way.surface.distance;
        const ContactFeatures& features = way.corners.features;
        const auto isClear = [&](const Vec3& centre, double radius) {
            return field.isClearOf(way.rotation * centre + way.translation, radius + clearance_);
        };
        std::vector<NearCorner>& near = side == 0 ? cornersOfA_ : cornersOfB_;
        if (!features.corners().empty()) {
            features.cornerTree().visit(isClear, [&](std::uint32_t i) {
                const std::int32_t corner = features.corners()[i];
                const Vec3 p = way.rotation * features.points().col(corner) + way.translation;
                const double atLeast = field.lowerBound(p);
                if (atLeast < clearance_) near.push_back({atLeast, corner});
            });
            std::sort(near.begin(), near.end(),
                      [](const NearCorner& p, const NearCorner& q) { return p.corner < q.corner; });
        }
        nearEdges[side].clear();
        if (way.surface.isPlane || features.edges().empty()) continue;
        features.edgeTree().visit(isClear, [&](std::uint32_t e) {
            const ConvexEdge& edge = features.edges()[e];
            const double half = 0.5 * edge.length;
            if (isClear(edge.start + half * edge.direction, half)) return;
            nearEdges[side].push_back(static_cast<std::int32_t>(e));
        });
        std::sort(nearEdges[side].begin(), nearEdges[side].end());
    }
    for (std::int32_t ofA : nearEdges[0]) {
        const ConvexEdge& a = shapeA.features.edges()[ofA];
        const double halfA = 0.5 * a.length;
        const Vec3 middleA = rotation * (a.start + halfA * a.direction) + translation;
        for (std::int32_t ofB : nearEdges[1]) {
            const ConvexEdge& b = shapeB.features.edges()[ofB];
            const double halfB = 0.5 * b.length;
            const double atLeast =
                apartAtLeast(middleA, halfA, b.start + halfB * b.direction, halfB);
            if (atLeast < clearance_) edges_.push_back({atLeast, ofA, ofB});
        }
    }
}

void NearFeatures::findContacts(const PlacedPair& pair, double reach,
                                std::vector<GapContact>& contacts)
{
    const Mat3 worldFromA = pair.worldFromA.orientation.toRotationMatrix();
    const Mat3 worldFromB = pair.worldFromB.orientation.toRotationMatrix();
    const Mat3 rotation = worldFromB.transpose() * worldFromA;
    const Vec3 offset = pair.worldFromA.position - pair.worldFromB.position;
    const Vec3 translation = worldFromB.transpose() * offset;

    // No point of either body has moved farther in the other's frame than this.
    const auto extent = [](const Shape& shape, double lever) {
        return shape.isPlane ? 0.0 : shape.boundingRadius + lever;
    };
    double travel = std::numeric_limits<double>::infinity();
    if (isKnown_) {
        travel = (translation - translation_).norm() +
                 (rotation - rotation_).norm() *
                     std::max(extent(*pair.shapeA, 0.0), extent(*pair.shapeB, translation.norm()));
    }
    if (reach + travel > clearance_) {
        clearance_ = reach + std::max(kLookAhead * reach, kLeastLookAhead * smallerRadius(pair));
        lookAgain(pair, rotation, translation);
        travel = 0.0;
    }

    const std::size_t first = contacts.size();
    const double samePlace = kSamePlace * smallerRadius(pair);
    const auto push = [&](std::uint64_t feature, const Vec3& onA, const Vec3& normal, double gap) {
        // Where two corners meet, or an edge ends on another, several features say the same.
        const Vec3 place = onA - 0.5 * gap * normal;
        for (std::size_t i = first; i < contacts.size(); ++i) {
            GapContact& known = contacts[i];
            if ((known.rA - place).squaredNorm() > samePlace * samePlace) continue;
            if (known.normal.dot(normal) < 1.0 - kSamePlace) continue;
            if (gap < known.gap) {
                known.gap = gap;
                known.rA = place;
                known.normal = normal;
            }
            return;
        }
        contacts.push_back({feature, place, normal, gap});
    };
    const double sharpness = kSharpness * smallerRadius(pair);
    std::optional<GapContact> unsupported;
    const auto faceCorners = [&](const Corners& way, const std::vector<NearCorner>& near,
                                 bool ofA) {
        for (const NearCorner& candidate : near) {
            if (candidate.atLeast >= reach + travel) continue;
            const Vec3 corner = way.corners.features.points().col(candidate.corner);
            const Vec3 p = way.rotation * corner + way.translation;
            SurfaceContact refused{Vec3::Zero(), 0.0};
            const auto contact = facing(way, candidate.corner, p, reach, sharpness, refused);
            const SurfaceContact& found = contact ? *contact : refused;
            if (!contact && refused.gap >= 0.0) continue;
            const std::uint64_t feature =
                featureId(ofA ? Kind::cornerOfA : Kind::cornerOfB, candidate.corner);
            const Vec3 normal =
                (ofA ? 1.0 : -1.0) * ((ofA ? worldFromB : worldFromA) * found.normal);
            const Vec3 onA =
                ofA ? Vec3(worldFromA * corner) : Vec3(worldFromA * p + found.gap * normal);
            if (contact) {
                push(feature, onA, normal, found.gap);
            } else if (!unsupported || found.gap < unsupported->gap) {
                unsupported =
                    GapContact{feature, onA - 0.5 * found.gap * normal, normal, found.gap};
            }
        }
    };
    // An exact ball touches with whatever of it is nearest: one place, never a corner.
    const auto faceBall = [&](const Shape& ball, const Shape& surface, const Vec3& centre,
                              bool ofA) {
        const double radius = ball.distance.solid()->half().x();
        const double gap = surface.distance.value(centre) - radius;
        if (gap >= reach) return;
        const Vec3 n = surface.distance.gridGradient(centre).normalized();
        const Vec3 normal = (ofA ? 1.0 : -1.0) * ((ofA ? worldFromB : worldFromA) * n);
        const Vec3 onA =
            ofA ? Vec3(-radius * normal) : Vec3(worldFromA * centre + (radius + gap) * normal);
        push(featureId(Kind::ball, ofA ? 0 : 1), onA, normal, gap);
    };
    if (isBall(*pair.shapeA)) {
        faceBall(*pair.shapeA, *pair.shapeB, translation, true);
        return;
    }
    if (isBall(*pair.shapeB)) {
        faceBall(*pair.shapeB, *pair.shapeA, -(rotation.transpose() * translation), false);
        return;
    }
    faceCorners({*pair.shapeA, *pair.shapeB, rotation, translation}, cornersOfA_, true);
    const Mat3 back = rotation.transpose();
    faceCorners({*pair.shapeB, *pair.shapeA, back, -(back * translation)}, cornersOfB_, false);
    for (const NearEdges& candidate : edges_) {
        if (candidate.atLeast >= reach + travel) continue;
        const auto contact =
            facing(pair, rotation, translation, candidate.ofA, candidate.ofB, reach, sharpness);
        if (!contact) continue;
        push(featureId(Kind::edges, candidate.ofA, candidate.ofB),
             worldFromB * contact->onA - offset, worldFromB * contact->normal, contact->gap);
    }

    // In a deep overlap the geometry of touching means little. A corner inside is still a corner
    // inside: without any contact that opposes, the deepest one speaks.
    if (!unsupported) return;
    const bool isOpposed =
        std::any_of(contacts.begin() + static_cast<std::ptrdiff_t>(first), contacts.end(),
                    [](const GapContact& c) { return c.gap < 0.0; });
    if (!isOpposed) contacts.push_back(*unsupported);
}

}  // namespace scree
