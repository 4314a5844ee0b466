// Symbols: a, b, c corners of a triangle, n its area vector, p, q ends of an edge.
#include "core/geometry/mesh_crossings.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>

#include "core/base/parallel.h"
#include "core/math/aabb.h"

namespace scree {
namespace {

constexpr double kTouching = 1e-6;  // of the mesh's diagonal

/// Where the edge pq goes through the triangle; both ends are farther from its plane, and the
/// crossing farther from its border, than `tolerance`.
std::optional<Vec3> pierce(const TriangleCorners& t, const Vec3& p, const Vec3& q, double tolerance)
{
    const Vec3 n = t.areaVector();
    const double length = n.norm();
    if (!(length > 0.0)) return std::nullopt;
    const double above = n.dot(p - t.a) / length, below = n.dot(q - t.a) / length;
    const bool crosses =
        (above > tolerance && below < -tolerance) || (above < -tolerance && below > tolerance);
    if (!crosses) return std::nullopt;
    const Vec3 place = p + above / (above - below) * (q - p);
    const auto isInside = [&](const Vec3& from, const Vec3& to) {
        const Vec3 edge = to - from;
        return n.dot(edge.cross(place - from)) > tolerance * length * edge.norm();
    };
    const bool hits = isInside(t.a, t.b) && isInside(t.b, t.c) && isInside(t.c, t.a);
    return hits ? std::optional<Vec3>(place) : std::nullopt;
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

/// A crossing with its place in the order in which they are told, and the edge that pierces.
struct Found {
    std::tuple<std::size_t, std::size_t, int, int> order;
    std::tuple<int, int, int> what;
    MeshCrossing crossing;
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
                const auto place =
                    pierce(corners, mesh.points.col(p), mesh.points.col(q), tolerance);
                if (!place) continue;
                found.push_back({{i, j, turn, k},
                                 {pierced, std::min(p, q), std::max(p, q)},
                                 {pierced, *place}});
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
    std::set<std::tuple<int, int, int>> seen;
    std::vector<MeshCrossing> crossings;
    for (const Found& one : found) {
        if (seen.insert(one.what).second) crossings.push_back(one.crossing);
    }
    return crossings;
}

}  // namespace scree
