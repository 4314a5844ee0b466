// Symbols: a, b, c corners of a triangle, n its area vector, p, q ends of an edge.
#include "core/geometry/mesh_crossings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "core/base/parallel.h"
#include "core/math/aabb.h"

namespace scree {
namespace {

constexpr double kTouching = 1e-6;  // of the mesh's diagonal

/// Where an edge goes through a triangle.
struct Hit {
    Vec3 place;
    bool isOutward;              // along the edge
    std::array<bool, 3> onSide;  // from each corner to the next: it lies on the border there

    bool isOnBorder() const { return onSide[0] || onSide[1] || onSide[2]; }
};

/// Both ends of pq are farther from the plane of the triangle than `tolerance`, and what lies
/// nearer to its border is on that.
std::optional<Hit> pierce(const TriangleCorners& t, const Vec3& p, const Vec3& q, double tolerance)
{
    const Vec3 n = t.areaVector();
    const double length = n.norm();
    if (!(length > 0.0)) return std::nullopt;
    const double above = n.dot(p - t.a) / length, below = n.dot(q - t.a) / length;
    const bool crosses =
        (above > tolerance && below < -tolerance) || (above < -tolerance && below > tolerance);
    if (!crosses) return std::nullopt;
    Hit hit{p + above / (above - below) * (q - p), above < 0.0, {}};
    const std::array<Vec3, 3> corners = {t.a, t.b, t.c};
    for (int k = 0; k < 3; ++k) {
        const Vec3 edge = corners[(k + 1) % 3] - corners[k];
        const double inward = n.dot(edge.cross(hit.place - corners[k])) / (length * edge.norm());
        if (inward < -tolerance) return std::nullopt;
        hit.onSide[k] = inward <= tolerance;
    }
    return hit;
}

/// A triangle and its box.
struct Boxed {
    Aabb box;
    int triangle;
};

/// All boxes by the strips along an axis that they reach into, and by their order in each. Sweeping
/// over all at once compares every triangle of a terrain with a whole row of it: of two million
/// triangles that took most of a start of half a minute.
class Strips {
public:
    Strips(const std::vector<Boxed>& all, const Aabb& whole, int axis)
        : axis_(axis), from_(whole.min[axis])
    {
        const double size = whole.size()[axis];
        double reach = 0.0;
        for (const Boxed& one : all)
            reach += one.box.size()[axis] / static_cast<double>(all.size());
        // At least twice as wide as triangles reach in the mean: there are few more members than
        // triangles, however long some of these are.
        const double most = std::sqrt(static_cast<double>(all.size())) / 4.0;
        const double count =
            std::max(1.0, std::floor(reach > 0.0 ? std::min(most, size / (2.0 * reach)) : most));
        perLength_ = size > 0.0 ? count / size : 0.0;
        members_.resize(static_cast<std::size_t>(count));
        for (std::size_t i = 0; i < all.size(); ++i) {
            const std::size_t last = stripAt(all[i].box.max[axis_]);
            for (std::size_t strip = stripAt(all[i].box.min[axis_]); strip <= last; ++strip)
                members_[strip].push_back(i);
        }
    }

    std::size_t count() const { return members_.size(); }
    const std::vector<std::size_t>& membersOf(std::size_t strip) const { return members_[strip]; }

private:
    std::size_t stripAt(double place) const
    {
        const auto strip = static_cast<std::size_t>(std::max(perLength_ * (place - from_), 0.0));
        return std::min(strip, members_.size() - 1);
    }

    int axis_;
    double from_, perLength_;
    std::vector<std::vector<std::size_t>> members_;
};

/// A triangle and the ends of an edge, the lower first.
using Piercing = std::tuple<int, int, int>;

/// A crossing with its place in the order in which they are told.
struct Found {
    std::tuple<std::size_t, std::size_t, int, int> order;
    Piercing what;
    Hit hit;
};

/// Which of what has been found goes through the surface. Solids modelled on a grid pierce each
/// other just where triangles border on each other; but an edge that touches another where it
/// passes goes through one of its faces inward and through the other outward.
class ThroughSurface {
public:
    ThroughSurface(const TriMesh& mesh, const std::vector<Found>& found) : mesh_(mesh)
    {
        for (const Found& one : found) isOutward_[one.what] = one.hit.isOutward;
        if (std::ranges::none_of(found, [](const Found& one) { return one.hit.isOnBorder(); }))
            return;
        around_.resize(static_cast<std::size_t>(mesh.points.cols()));
        for (int f = 0; f < static_cast<int>(mesh.triangles.cols()); ++f) {
            for (const int point : mesh.triangles.col(f)) around_[point].push_back(f);
        }
    }

    bool goesThrough(const Found& found) const
    {
        if (!found.hit.isOnBorder()) return true;
        const auto [pierced, p, q] = found.what;
        const std::vector<int> shared = sharedPoints(pierced, found.hit);
        if (shared.empty()) return false;
        return std::ranges::all_of(around_[shared.front()], [&](int f) {
            const auto corners = mesh_.triangles.col(f).array();
            if (!(corners == shared.back()).any()) return true;
            const auto same = isOutward_.find({f, p, q});
            return same != isOutward_.end() && same->second == found.hit.isOutward;
        });
    }

private:
    /// The ends of the side that it lies on, or the corner between two sides.
    std::vector<int> sharedPoints(int pierced, const Hit& hit) const
    {
        std::vector<int> points;
        for (int k = 0; k < 3; ++k) {
            const bool isBefore = hit.onSide[(k + 2) % 3], isAfter = hit.onSide[k];
            const int sides = hit.onSide[0] + hit.onSide[1] + hit.onSide[2];
            const bool isShared = sides == 1 ? isBefore || isAfter : isBefore && isAfter;
            if (isShared) points.push_back(mesh_.triangles(k, pierced));
        }
        return points;
    }

    const TriMesh& mesh_;
    std::map<Piercing, bool> isOutward_;
    std::vector<std::vector<int>> around_;  // triangles, by point
};

bool sharesPoint(const TriMesh& mesh, int f, int g)
{
    for (int k = 0; k < 3; ++k) {
        for (int l = 0; l < 3; ++l) {
            if (mesh.triangles(k, f) == mesh.triangles(l, g)) return true;
        }
    }
    return false;
}

}  // namespace

std::vector<MeshCrossing> findCrossings(const TriMesh& mesh)
{
    const auto count = static_cast<std::size_t>(mesh.triangles.cols());
    std::vector<Boxed> all(count);
    Aabb whole;
    for (std::size_t i = 0; i < count; ++i) {
        all[i].triangle = static_cast<int>(i);
        for (int k = 0; k < 3; ++k)
            all[i].box.include(mesh.points.col(mesh.triangles(k, all[i].triangle)));
        whole.include(all[i].box.min);
        whole.include(all[i].box.max);
    }
    const double tolerance = kTouching * whole.diagonal();

    // Sweep along the longest axis, in strips along the next: only triangles whose boxes overlap
    // there can meet.
    Eigen::Index axis, across;
    whole.size().maxCoeff(&axis);
    Vec3 others = whole.size();
    others[axis] = -1.0;
    others.maxCoeff(&across);
    std::sort(all.begin(), all.end(), [&](const Boxed& f, const Boxed& g) {
        return std::tuple(f.box.min[axis], f.triangle) < std::tuple(g.box.min[axis], g.triangle);
    });
    const Strips strips(all, whole, static_cast<int>(across));
    std::vector<std::vector<Found>> foundIn(strips.count());
    forEach(strips.count(), 1, [&](std::size_t strip) {
        const std::vector<std::size_t>& members = strips.membersOf(strip);
        const auto test = [&](std::size_t i, std::size_t j, int turn, std::vector<Found>& found) {
            const int pierced = all[turn == 0 ? i : j].triangle;
            const int other = all[turn == 0 ? j : i].triangle;
            const TriangleCorners corners = cornersOf(mesh, pierced);
            for (int k = 0; k < 3; ++k) {
                const int p = mesh.triangles(k, other), q = mesh.triangles((k + 1) % 3, other);
                const auto [low, high] = std::minmax(p, q);
                const auto hit =
                    pierce(corners, mesh.points.col(low), mesh.points.col(high), tolerance);
                if (hit) found.push_back({{i, j, turn, k}, {pierced, low, high}, *hit});
            }
        };
        // Where there is one strip alone, all threads share it.
        std::vector<std::vector<Found>> ofMembers(members.size());
        forEach(members.size(), kShortWork, [&](std::size_t m) {
            const Boxed& f = all[members[m]];
            for (std::size_t n = m + 1; n < members.size(); ++n) {
                const Boxed& g = all[members[n]];
                if (g.box.min[axis] > f.box.max[axis]) break;
                if (!f.box.overlaps(g.box) || sharesPoint(mesh, f.triangle, g.triangle)) continue;
                test(members[m], members[n], 0, ofMembers[m]);
                test(members[m], members[n], 1, ofMembers[m]);
            }
        });
        for (const std::vector<Found>& some : ofMembers)
            foundIn[strip].insert(foundIn[strip].end(), some.begin(), some.end());
    });

    std::vector<Found> found;
    for (const std::vector<Found>& some : foundIn)
        found.insert(found.end(), some.begin(), some.end());
    std::sort(found.begin(), found.end(),
              [](const Found& a, const Found& b) { return a.order < b.order; });
    // An edge has two faces, and two triangles may meet in several strips: it is told once.
    std::set<Piercing> seen;
    std::vector<MeshCrossing> crossings;
    const ThroughSurface surface(mesh, found);
    for (const Found& one : found) {
        if (seen.insert(one.what).second && surface.goesThrough(one))
            crossings.push_back({std::get<0>(one.what), one.hit.place});
    }
    return crossings;
}

}  // namespace scree
