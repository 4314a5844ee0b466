// Symbols: n common normal, out of the second body; x place of the first, y of the second; t what
//          is between them across n: of two places that face each other nothing.
#include "core/collision/round_contacts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/geometry/surface_normal.h"

namespace scree {
namespace {

using Kind = ContactPart::Kind;
using Search = RoundSearch;
using Result = Rounding::Result;

constexpr int kMostTurns = 12;
/// Farthest two places may lie beside each other, as a share of the smaller body.
constexpr double kOpposite = 1e-11;
/// A turn of n larger than this is cut [rad]: places advance by facets, not evenly.
constexpr double kLargestTurn = 0.2;

/// A sharp feature is met only from the directions in between its faces: beyond, the face is
/// nearer. A sine, for rounding.
constexpr double kStrictly = 1e-6;

/// Sine of the angle between the axes of two sides below which they lie along each other.
constexpr double kParallel = 1e-2;

/// Heights that differ by less than this share of the smaller body are one; for rounding.
constexpr double kSameHeight = 1e-7;

/// Sine of how far facets may lie off the axis of the cylinder that they stand for: files round.
constexpr double kAlongTube = 1e-4;

/// Cosine of the bend from which any edge is one over which something rolls. What bends less does
/// it on what is so many times as large, as a ground: a coarse ring lies against a pole with its
/// facets.
constexpr double kSharpBend = 0.5, kMuchLarger = 2.0;

/// Cosine, taken from 1, of the angle within which a normal is that of a face.
constexpr double kSameFace = 1e-9;

/// Of a triangle the one that is nearest to a place.
std::int32_t nearestVertex(const Shape& shape, std::int32_t triangle, const Vec3& place)
{
    const auto corners = shape.mesh.triangles.col(triangle);
    const auto distance = [&](int k) {
        return (shape.mesh.points.col(corners[k]) - place).squaredNorm();
    };
    int nearest = 0;
    for (int k = 1; k < 3; ++k) {
        if (distance(k) < distance(nearest)) nearest = k;
    }
    return corners[nearest];
}

const Mat3 kUnturned = Mat3::Identity();
const Vec3 kUnmoved = Vec3::Zero();

/// Of the ball at an end of a capsule; of what is between the ends, the middle.
Vec3 centreOf(const Capsule& capsule, std::int32_t part)
{
    return part == 0 ? Vec3(Vec3::Zero()) : part == 1 ? Vec3(-capsule.half) : capsule.half;
}

/// The radius of the cylinder about the centre of a shape that an edge between two of its facets
/// lies on, if it is one [m].
std::optional<double> tubeAt(const Shape& shape, const ConvexEdge& edge)
{
    const auto isAcross = [](const Vec3& normal, int axis) {
        return std::abs(normal[axis]) < kAlongTube;
    };
    for (int axis = 0; axis < 3; ++axis) {
        if (shape.turnsThatShow[axis] > 0.0) continue;
        if (!isAcross(edge.faceNormal[0], axis) || !isAcross(edge.faceNormal[1], axis)) continue;
        Vec3 arm = edge.start;
        arm[axis] = 0.0;
        return arm.norm();
    }
    return {};
}

/// One body of a contact, seen from the second.
class TouchingBody {
public:
    /// `near` is a place of the contact; `outward` points at the other body. Both in the frame of
    /// the second shape, like all that comes out.
    TouchingBody(const Shape& shape, ContactPart part, const Mat3& rotation,
                 const Vec3& translation, const Vec3& near, const Vec3& outward)
        : shape_(shape), part_(part), rotation_(rotation), translation_(translation)
    {
        if (part.kind == Kind::ball) {
            isRound_ = true;
            isSide_ = part.index == 0 && !shape.isBall();
            if (isSide_) axis_ = (rotation * shape.capsule.half).normalized();
            centre_ = rotation * centreOf(shape.capsule, part.index) + translation;
            place_ = {centre_, 0.0, shape.capsule.radius * Mat3::Identity()};
            return;
        }
        if (!shape.roundFacets.isEmpty()) {
            findFacet(rotation.transpose() * (near - translation), rotation.transpose() * outward);
        }
        if (facet_ < 0) rim_ = rim();
        isRound_ = isRound_ || isRoundMesh();
        if (isSide_) axis_ = rotation * *shape.roundFacets.axisOf(facet_);
        if (isRound_) return;
        place_ = {near, 0.0, Mat3::Zero()};
        if (part.kind != Kind::edge) return;
        axis_ = rotation * edge().direction;
        tube_ = tubeAt(shape, edge());
    }

    bool isRound() const { return isRound_; }
    bool isRoundMesh() const { return facet_ >= 0 || rim_ >= 0; }
    /// Round about an axis; n stays across it.
    bool isSide() const { return isSide_; }
    bool isFlat() const { return !isRound_ && part_.kind == Kind::face; }
    bool isEdge() const { return !isRound_ && part_.kind == Kind::edge; }
    /// Whether it is an edge that something of this size rolls over.
    bool isRolledOver(const Shape& other) const
    {
        if (!isEdge()) return false;
        return shape_.boundingRadius >= kMuchLarger * other.boundingRadius ||
               edge().faceNormal[0].dot(edge().faceNormal[1]) < kSharpBend;
    }
    /// An edge between facets of a cylinder: its radius, else nothing [m].
    const std::optional<double>& tube() const { return tube_; }
    /// Of a side or a sharp edge; n stays across it.
    const std::optional<Vec3>& axis() const { return axis_; }
    const RoundPlace& place() const { return place_; }

    Search turnTo(const Vec3& outward)
    {
        if (tube_) place_.point = *tube_ * outward + translation_;
        if (!isRound_) return Search::found;
        if (part_.kind == Kind::ball) {
            place_.point = centre_ + shape_.capsule.radius * outward;
            return Search::found;
        }
        const Vec3 own = rotation_.transpose() * outward;
        const Search search = isSide_     ? shape_.roundFacets.findAcross(facet_, own, place_)
                              : rim_ >= 0 ? shape_.rims.findFacing(rim_, own, place_)
                                          : shape_.roundFacets.findFacing(facet_, own, place_);
        place_.point = rotation_ * place_.point + translation_;
        place_.advance = rotation_ * place_.advance * rotation_.transpose();
        return search;
    }

    /// Whether nothing beside the sharp feature is nearer to what is at `other`.
    bool isNearest(const Vec3& outward, const Vec3& other) const
    {
        const Vec3 inward = -(rotation_.transpose() * outward);
        if (part_.kind == Kind::ball) {
            return !isSide_ ||
                   std::abs(axis_->dot(other - translation_)) <= shape_.capsule.half.norm();
        }
        if (isSide_) {
            const Vec3 opposite = other - outward.dot(other - place_.point) * outward;
            const Vec3 here = rotation_.transpose() * (opposite - translation_);
            return shape_.roundFacets.axisOf(shape_.rays.closestTriangle(here)).has_value();
        }
        if (place_.isPastEnd) return false;
        if (isRound_ || part_.kind == Kind::face) return true;
        if (part_.kind == Kind::corner)
            return shape_.features.cornerSupports(part_.index, inward, kStrictly);
        return isAlongEdge(other) && edgeSupports(edge(), inward, kStrictly);
    }

    /// Whether a sharp edge is as long as it has to be to meet what is at `other`.
    bool isAlongEdge(const Vec3& other) const
    {
        const double along = axis_->dot(other - (rotation_ * edge().start + translation_));
        return along >= 0.0 && along <= edge().length;
    }

    /// The face of a sharp edge that is nearer than the edge to what is met that way: a place on it
    /// and its normal.
    struct Face {
        Vec3 place, normal;
    };
    std::optional<Face> faceBeside(const Vec3& outward) const
    {
        if (isRound_ || part_.kind != Kind::edge) return {};
        const Vec3 inward = -(rotation_.transpose() * outward);
        for (const int k : {0, 1}) {
            if (edge().intoFace[k].dot(inward) < -kStrictly)
                return Face{rotation_ * edge().start + translation_,
                            rotation_ * edge().faceNormal[k]};
        }
        return {};
    }

    std::int32_t partWithin() const
    {
        if (part_.kind == Kind::ball) return part_.index;
        if (tube_) return 1;  // all along its circle: it rolls
        if (isRound_ || part_.kind == Kind::face) return 0;
        return 2 * part_.index + (part_.kind == Kind::corner ? 1 : 2);
    }

private:
    const ConvexEdge& edge() const { return shape_.features.edges()[part_.index]; }
    std::int32_t rim() const
    {
        if (part_.kind == Kind::corner) return shape_.rims.atCorner(part_.index);
        return part_.kind == Kind::edge ? shape_.rims.ofEdge(part_.index) : -1;
    }

    /// All in the frame of the shape.
    void findFacet(const Vec3& near, const Vec3& outward)
    {
        std::int32_t vertex = part_.index;
        if (part_.kind == Kind::edge) {
            vertex = edge().ends[0];
            facet_ = shape_.roundFacets.sideAtEdge(vertex, edge().ends[1]);
        } else if (part_.kind == Kind::face) {
            facet_ = shape_.rays.closestTriangle(near);
            vertex = nearestVertex(shape_, facet_, near);
        }
        const auto isOfSide = [&] { return facet_ >= 0 && shape_.roundFacets.axisOf(facet_); };
        if (part_.kind == Kind::corner || !isOfSide())
            facet_ = shape_.roundFacets.atVertex(vertex, outward);
        // Where what is round ends in a rim, the next hair of a tilt would find no facet.
        if (facet_ >= 0 && rim() >= 0 && !shape_.roundFacets.areRoundAround(vertex)) facet_ = -1;
        isSide_ = isOfSide();
    }

    const Shape& shape_;
    ContactPart part_;
    const Mat3& rotation_;
    const Vec3& translation_;
    Vec3 centre_;                         // of a ball
    std::int32_t facet_ = -1, rim_ = -1;  // the one or the other where a mesh is round
    bool isRound_ = false, isSide_ = false;
    RoundPlace place_;
    std::optional<Vec3> axis_;
    std::optional<double> tube_;  // about the centre of the shape
};

/// The turn of n that brings two places opposite each other that are now t apart, as they advance.
/// Nothing when there is none: bodies that fit into each other.
std::optional<Vec3> turnFor(const Mat3& advance, const Vec3& n, const Vec3& t,
                            const std::optional<Vec3>& axis)
{
    if (axis) {
        const Vec3 across = n.cross(*axis);
        const double radius = across.dot(advance * across);
        if (!(radius > 0.0)) return {};
        return Vec3(across.dot(t) / radius * across);
    }
    const Vec3 p = n.unitOrthogonal(), q = n.cross(p);
    const Vec3 ofP = advance * p, ofQ = advance * q;
    const double a = p.dot(ofP), b = p.dot(ofQ), c = q.dot(ofP), d = q.dot(ofQ);
    const double determinant = a * d - b * c;
    if (!(determinant > 0.0 && a + d > 0.0)) return {};
    const double tp = p.dot(t), tq = q.dot(t);
    return Vec3((d * tp - b * tq) / determinant * p + (a * tq - c * tp) / determinant * q);
}

/// Whether a place is, give or take `tolerance`, on a face with this normal: not on an edge that is
/// seen from aside, nor past the end of the face. There its plane may go on for a good way close
/// above the facets beside it: two forks nested in each other were told of 36 µm of overlap that
/// there was not, in one step but not the next. In the frame of the shape.
bool isOnFace(const Shape& shape, const Vec3& place, const Vec3& normal, double tolerance)
{
    if (shape.isPlane) return true;
    if (std::abs(shape.distance.value(place)) > tolerance) return false;
    if (shape.distance.solid()) return true;
    thread_local std::vector<int> triangles;
    triangles.clear();
    shape.rays.trianglesWithin(place, tolerance, triangles);
    return std::any_of(triangles.begin(), triangles.end(), [&](int triangle) {
        return cornersOf(shape.mesh, triangle).normal().dot(normal) > 1.0 - kSameFace;
    });
}

/// A round body on a flat one: the flat one gives the normal.
Rounding onFlat(const RelativePair& pair, TouchingBody& first, TouchingBody& second,
                const FeatureContact& contact)
{
    const Vec3& n = contact.normal;
    TouchingBody& round = first.isRound() ? first : second;
    const Search search = round.turnTo(first.isRound() ? Vec3(-n) : n);
    if (search == Search::notRound || search == Search::onSide) return {};
    if (search == Search::elsewhere) return {Result::elsewhere};
    const RoundPlace& place = round.place();
    const Vec3 placeOnFlat =
        first.isRound() ? Vec3(contact.point - contact.gap * n) : contact.point;
    const Shape& flat = first.isRound() ? pair.second : pair.first;
    const auto inFlat = [&](const Vec3& at) {
        return first.isRound() ? at : Vec3(pair.rotation.transpose() * (at - pair.translation));
    };
    const Vec3 outOfFlat = first.isRound() ? n : Vec3(-(pair.rotation.transpose() * n));
    const auto isOnFlat = [&](const Vec3& at) {
        return isOnFace(flat, inFlat(at), outOfFlat, sharpnessOf(pair));
    };
    if (!isOnFlat(placeOnFlat)) return {Result::elsewhere};
    if (!flat.hollows.isEmpty()) {
        const Mat3 advance = first.isRound()
                                 ? place.advance
                                 : Mat3(pair.rotation.transpose() * place.advance * pair.rotation);
        const Shape& other = first.isRound() ? pair.first : pair.second;
        const std::int32_t facet = flat.rays.closestTriangle(inFlat(placeOnFlat));
        if (flat.hollows.isFittedBy(facet, advance, other.bulge())) return {};
    }
    const double side = first.isRound() ? 1.0 : -1.0;
    const double gap = side * n.dot(place.point - placeOnFlat) - place.bulge;
    const Vec3 smooth = place.point - side * place.bulge * n;
    const Vec3 foot = smooth - side * gap * n;
    if (!isOnFlat(foot)) return {Result::elsewhere};
    return {Result::rounded, {first.isRound() ? smooth : foot, n, gap}};
}

/// Whether the place that faces what is flat lies higher above that than the corner that was found
/// there, which the round surface goes through: where normals do not fit the corners, as on a rock.
bool isAboveCorner(const RelativePair& pair, const FeatureContact& corner, const Rounding& rounding)
{
    return rounding.result == Result::rounded &&
           rounding.contact.gap > corner.gap + kSameHeight * smallerRadius(pair.first, pair.second);
}

/// A round body beside a sharp edge, on one of its faces: no corner of the round one need be near
/// that. Where a coin leans on the side of another that edge spoke with its facets, in one step but
/// not the next, 2e-3 of the coin apart.
Rounding besideEdge(const RelativePair& pair, TouchingBody& first, TouchingBody& second,
                    const Vec3& n)
{
    if (const auto face = second.faceBeside(n))
        return onFlat(pair, first, second, {face->place, face->normal, 0.0});
    if (const auto face = first.faceBeside(-n))
        return onFlat(pair, first, second, {face->place, -face->normal, 0.0});
    return {Result::elsewhere};
}

/// Two sides that cross, or what is round about an axis and an edge: n is across both axes. That an
/// edge is met from there has been seen: those of the facets are all along that axis.
Rounding betweenSides(TouchingBody& first, TouchingBody& second, const FeatureContact& contact)
{
    const auto isThere = [](const TouchingBody& side, const Vec3& outward, const Vec3& other) {
        return side.isEdge() ? side.isAlongEdge(other) : side.isNearest(outward, other);
    };
    const Vec3 &a = *first.axis(), &b = *second.axis();
    const Vec3 across = a.cross(b);
    if (across.norm() < kParallel) return {};
    const Vec3 n = (across.dot(contact.normal) > 0.0 ? across : Vec3(-across)).normalized();
    if (first.turnTo(-n) != Search::found || second.turnTo(n) != Search::found)
        return {Result::elsewhere};
    const RoundPlace &x = first.place(), &y = second.place();
    const Vec3 between = y.point - x.point;
    const Vec3 onX = x.point + b.cross(n).dot(between) / b.cross(n).dot(a) * a;
    if (!isThere(first, -n, onX) || !isThere(second, n, onX)) return {Result::elsewhere};
    const double apart = -n.dot(between);
    return {Result::rounded,
            {onX - x.bulge * n, n, apart - x.bulge - y.bulge},
            first.partWithin(),
            second.partWithin()};
}

/// Whether surfaces that have passed each other there lie in each other by a good part of that. The
/// rim of a can that slides over a seam passes the side of the block ahead, but on top of it: told
/// of that it stopped, or fell over. The field of the one whose facets lie less deep below what
/// they stand for tells.
bool areInEachOther(const RelativePair& pair, const FeatureContact& contact)
{
    constexpr double kPart = 0.25;
    if (contact.gap >= -sharpnessOf(pair)) return true;  // as good as touching
    const bool isBySecond = pair.second.bulge() <= pair.first.bulge();
    const Shape& shape = isBySecond ? pair.second : pair.first;
    const Vec3 onSecond = contact.point - contact.gap * contact.normal;
    const Vec3 place = isBySecond ? contact.point : pair.reversed() * onSecond;
    return shape.distance.value(place) < kPart * contact.gap + shape.bulge();
}

Rounding rounded(const RelativePair& pair, ContactPart ofFirst, ContactPart ofSecond,
                 const FeatureContact& contact)
{
    Vec3 n = contact.normal;
    TouchingBody first(pair.first, ofFirst, pair.rotation, pair.translation, contact.point, -n);
    TouchingBody second(pair.second, ofSecond, kUnturned, kUnmoved, contact.point - contact.gap * n,
                        n);
    const auto rolls = [](const TouchingBody& side) {
        return side.tube() || (side.isSide() && side.isRoundMesh());
    };
    const auto crosses = [](const TouchingBody& side, const Shape& other) {
        return side.tube() || side.isSide() || side.isRolledOver(other);
    };
    if ((rolls(first) && crosses(second, pair.first)) ||
        (crosses(first, pair.second) && rolls(second)))
        return betweenSides(first, second, contact);
    if (!first.isRoundMesh() && !second.isRoundMesh()) return {};
    // To what else is sharp or flat a side is its facets: a pole holds rings as well so.
    if ((first.isSide() && !second.isRound()) || (second.isSide() && !first.isRound())) return {};
    if (first.isFlat() || second.isFlat()) {
        const Rounding rounding = onFlat(pair, first, second, contact);
        return isAboveCorner(pair, contact, rounding) ? Rounding{} : rounding;
    }

    const std::optional<Vec3>& axis = first.axis() ? first.axis() : second.axis();
    if (axis) n = (n - axis->dot(n) * *axis).normalized();
    const double opposite = kOpposite * smallerRadius(pair.first, pair.second);
    for (int turn = 0; turn < kMostTurns; ++turn) {
        const Search ofX = first.turnTo(-n), ofY = second.turnTo(n);
        if (ofX == Search::notRound || ofY == Search::notRound) return {};
        if (ofX != Search::found || ofY != Search::found) return {Result::elsewhere};
        const RoundPlace &x = first.place(), &y = second.place();
        const Vec3 between = x.point - y.point;
        const double apart = n.dot(between);
        Vec3 t = between - apart * n;
        if (axis) t -= axis->dot(t) * *axis;
        if (t.norm() > opposite) {
            const Mat3 advance = x.advance + y.advance + apart * Mat3::Identity();
            std::optional<Vec3> change = turnFor(advance, n, t, axis);
            if (!change) return {};
            const double angle = change->norm();
            if (angle > kLargestTurn) *change *= kLargestTurn / angle;
            n = (n + *change).normalized();
            continue;
        }
        const Vec3 onX = first.axis() ? Vec3(y.point + apart * n) : x.point;
        if (!first.isNearest(-n, y.point) || !second.isNearest(n, x.point)) {
            const Rounding onFace = besideEdge(pair, first, second, n);
            return onFace.result == Result::rounded ? onFace : Rounding{Result::elsewhere};
        }
        return {Result::rounded,
                {onX - x.bulge * n, n, apart - x.bulge - y.bulge},
                first.partWithin(),
                second.partWithin()};
    }
    return {};
}

}  // namespace

Rounding roundContact(const RelativePair& pair, ContactPart ofFirst, ContactPart ofSecond,
                      const FeatureContact& contact)
{
    const Rounding rounding = rounded(pair, ofFirst, ofSecond, contact);
    const bool isThere =
        rounding.result != Result::rounded || areInEachOther(pair, rounding.contact);
    return isThere ? rounding : Rounding{Result::elsewhere};
}

std::optional<Vec3> placeOnRim(const Shape& shape, const Vec3& near, const Vec3& outward)
{
    if (shape.rims.bulge() == 0.0) return {};
    std::int32_t vertex = 0;
    if (shape.distance.solid()) {  // has no rays, and few vertices
        (shape.mesh.points.colwise() - near).colwise().squaredNorm().minCoeff(&vertex);
    } else {
        vertex = nearestVertex(shape, shape.rays.closestTriangle(near), near);
    }
    std::int32_t rim = shape.rims.atCorner(vertex);
    RoundPlace place;
    if (rim < 0 || shape.rims.findFacing(rim, outward, place) != Search::found) return {};
    return Vec3(place.point + place.bulge * outward);
}

}  // namespace scree
