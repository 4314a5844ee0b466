// Symbols: c centre of the ball in the frame of the other body, n normal out of its surface.
#include "core/collision/ball_contacts.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/geometry/triangle_distance.h"

namespace scree {
namespace {

/// Places count as equally near within this share of the ball's radius: rounding must not make
/// each of two triangles hold the other for the nearer one.
constexpr double kEquallyNear = 1e-9;

using PlaceId = std::array<std::int32_t, 2>;

struct Place {
    PlaceId id;
    Vec3 point;
    double distance;
    Vec3 faceNormal;  // of a triangle that holds it
};

/// How near a triangle comes that has a corner or an edge in common with others.
struct Neighbour {
    PlaceId id;  // of what is common
    double distance;
};

PlaceId edgeId(const TriMesh& mesh, int triangle, int side)
{
    const auto [low, high] =
        std::minmax(mesh.triangles(side, triangle), mesh.triangles((side + 1) % 3, triangle));
    return {low + 1, high + 1};
}

PlaceId cornerId(const TriMesh& mesh, int triangle, int corner)
{
    const std::int32_t point = mesh.triangles(corner, triangle) + 1;
    return {point, point};
}

PlaceId placeId(const TriMesh& mesh, int triangle, TriangleFeature feature)
{
    const int k = static_cast<int>(feature);
    if (feature == TriangleFeature::face) return {triangle, 0};
    return k < 3 ? cornerId(mesh, triangle, k) : edgeId(mesh, triangle, k - 3);
}

Place nearestPlace(const TriMesh& mesh, int triangle, const Vec3& c)
{
    const TriangleCorners corners = cornersOf(mesh, triangle);
    const Vec3 normal = corners.normal();
    const ClosestOnTriangle closest = closestOnTriangle(c, corners);
    // The plane's distance keeps its last bits where the square root of a square would not.
    const double distance = closest.feature == TriangleFeature::face
                                ? std::abs(normal.dot(c - corners.a))
                                : (c - closest.point).norm();
    return {placeId(mesh, triangle, closest.feature), closest.point, distance, normal};
}

/// The nearest place of every triangle within `reach` of c, and how near each comes.
void lookAround(const Shape& surface, const Vec3& c, double reach, std::vector<Place>& places,
                std::vector<Neighbour>& neighbours)
{
    thread_local std::vector<int> triangles;
    surface.rays.trianglesWithin(c, reach, triangles);
    places.clear();
    neighbours.clear();
    for (const int triangle : triangles) {
        const Place place = nearestPlace(surface.mesh, triangle, c);
        places.push_back(place);
        for (int k = 0; k < 3; ++k) {
            neighbours.push_back({cornerId(surface.mesh, triangle, k), place.distance});
            neighbours.push_back({edgeId(surface.mesh, triangle, k), place.distance});
        }
    }
    std::sort(places.begin(), places.end(),
              [](const Place& a, const Place& b) { return a.id < b.id; });
    const auto isSame = [](const Place& a, const Place& b) { return a.id == b.id; };
    places.erase(std::unique(places.begin(), places.end(), isSame), places.end());
    std::sort(neighbours.begin(), neighbours.end(), [](const Neighbour& a, const Neighbour& b) {
        return std::pair(a.id, a.distance) < std::pair(b.id, b.distance);
    });
}

/// Whether c is nearer to the place than to what surrounds it. A triangle that holds the place and
/// comes nearer elsewhere comes nearer at once, for a triangle is convex.
bool isNearest(const Place& place, const Vec3& c, const std::vector<Neighbour>& neighbours,
               double slack)
{
    const bool isOnFace = place.id[1] == 0;
    if (isOnFace) return place.faceNormal.dot(c - place.point) > 0.0;
    const auto nearest =
        std::lower_bound(neighbours.begin(), neighbours.end(), place.id,
                         [](const Neighbour& n, const PlaceId& id) { return n.id < id; });
    return nearest->distance >= place.distance - slack;
}

/// What the distance field alone tells: all there is to tell of a convex solid, and the way out for
/// a ball that has its centre inside of a mesh.
void findByField(const SignedDistance& field, const Vec3& c, double radius, double reach,
                 std::vector<BallContact>& found)
{
    const double gap = field.value(c) - radius;
    if (gap >= reach) return;
    Vec3 n = field.gridGradient(c).normalized();
    if (n.isZero(0.0)) n = Vec3::UnitY();  // as far from all sides
    found.push_back({{0, 0}, {c - radius * n, n, gap}});
}

}  // namespace

void findBallContacts(const Ball& ball, const Shape& surface, double reach,
                      std::vector<BallContact>& found)
{
    found.clear();
    const SignedDistance& field = surface.distance;
    const auto& [c, radius] = ball;
    if (field.lowerBound(c) - radius >= reach) return;
    if (field.solid() || field.value(c) <= kSharpness * radius) {
        return findByField(field, c, radius, reach, found);
    }

    thread_local std::vector<Place> places;
    thread_local std::vector<Neighbour> neighbours;
    lookAround(surface, c, radius + reach, places, neighbours);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Place& place : places) nearest = std::min(nearest, place.distance);
    const double slack = kEquallyNear * radius;
    for (const Place& place : places) {
        if (place.distance - radius >= reach) continue;
        // Whatever rounding makes of its surroundings, what is nearest of all is touched.
        if (place.distance > nearest && !isNearest(place, c, neighbours, slack)) continue;
        const Vec3 n = (c - place.point) / place.distance;
        found.push_back({place.id, {c - radius * n, n, place.distance - radius}});
    }
}

}  // namespace scree
