#include "core/geometry/primitives.h"

#include <map>
#include <utility>
#include <vector>

#include "core/math/rotation.h"

namespace scree {
namespace {

/// Collects points and triangles; grids and fans are all that the primitives need.
class Builder {
public:
    int point(const Vec3& p)
    {
        points_.push_back(p);
        return static_cast<int>(points_.size()) - 1;
    }
    void triangle(int a, int b, int c) { triangles_.push_back({a, b, c}); }
    void quad(int a, int b, int c, int d)
    {
        triangle(a, b, c);
        triangle(a, c, d);
    }
    TriMesh mesh() const
    {
        TriMesh result;
        result.points.resize(3, static_cast<Eigen::Index>(points_.size()));
        for (std::size_t i = 0; i < points_.size(); ++i) result.points.col(i) = points_[i];
        result.triangles.resize(3, static_cast<Eigen::Index>(triangles_.size()));
        for (std::size_t i = 0; i < triangles_.size(); ++i) {
            for (int k = 0; k < 3; ++k) result.triangles(k, i) = triangles_[i][k];
        }
        return result;
    }
    std::vector<Vec3>& points() { return points_; }

private:
    std::vector<Vec3> points_;
    std::vector<std::array<int, 3>> triangles_;
};

/// Surface of revolution about +y between two poles: one circle of `sectors` points per (radius,
/// y), from bottom to top, closed by fans.
TriMesh revolve(const std::vector<std::pair<double, double>>& profile, double bottomY, double topY,
                int sectors)
{
    Builder builder;
    for (const auto& [radius, y] : profile) {
        for (int i = 0; i < sectors; ++i) {
            double s = 0.0, c = 0.0;
            sinCos(2.0 * kPi * i / sectors, s, c);
            builder.point({radius * c, y, radius * s});
        }
    }
    const int rings = static_cast<int>(profile.size());
    for (int k = 0; k + 1 < rings; ++k) {
        for (int i = 0; i < sectors; ++i) {
            const int a = k * sectors + i, b = k * sectors + (i + 1) % sectors;
            builder.quad(a, a + sectors, b + sectors, b);
        }
    }
    const int bottom = builder.point({0.0, bottomY, 0.0});
    const int top = builder.point({0.0, topY, 0.0});
    for (int i = 0; i < sectors; ++i) {
        const int next = (i + 1) % sectors;
        builder.triangle(bottom, i, next);
        builder.triangle(top, (rings - 1) * sectors + next, (rings - 1) * sectors + i);
    }
    return builder.mesh();
}

}  // namespace

TriMesh makeBox(const Vec3& size, const std::array<int, 3>& segments)
{
    // Points live on the surface of an integer lattice, so that faces share them.
    Builder builder;
    std::map<std::array<int, 3>, int> indexOf;
    const auto point = [&](const std::array<int, 3>& lattice) {
        const auto [entry, isNew] = indexOf.try_emplace(lattice, 0);
        if (isNew) {
            Vec3 p;
            for (int k = 0; k < 3; ++k) {
                p[k] = size[k] * (static_cast<double>(lattice[k]) / segments[k] - 0.5);
            }
            entry->second = builder.point(p);
        }
        return entry->second;
    };

    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (int side = 0; side < 2; ++side) {
            for (int i = 0; i < segments[u]; ++i) {
                for (int j = 0; j < segments[v]; ++j) {
                    const auto corner = [&](int di, int dj) {
                        std::array<int, 3> lattice{};
                        lattice[axis] = side * segments[axis];
                        lattice[u] = i + di;
                        lattice[v] = j + dj;
                        return point(lattice);
                    };
                    const int a = corner(0, 0), b = corner(1, 0), c = corner(1, 1),
                              d = corner(0, 1);
                    if (side == 1) {
                        builder.quad(a, b, c, d);
                    } else {
                        builder.quad(a, d, c, b);
                    }
                }
            }
        }
    }
    return builder.mesh();
}

TriMesh makeTorus(double majorRadius, double minorRadius, const std::array<int, 2>& segments)
{
    Builder builder;
    for (int i = 0; i < segments[0]; ++i) {
        double su = 0.0, cu = 0.0;
        sinCos(2.0 * kPi * i / segments[0], su, cu);
        for (int j = 0; j < segments[1]; ++j) {
            double sv = 0.0, cv = 0.0;
            sinCos(2.0 * kPi * j / segments[1], sv, cv);
            const double rho = majorRadius + minorRadius * cv;
            builder.point({rho * cu, minorRadius * sv, rho * su});
        }
    }
    for (int i = 0; i < segments[0]; ++i) {
        for (int j = 0; j < segments[1]; ++j) {
            const int iNext = (i + 1) % segments[0], jNext = (j + 1) % segments[1];
            builder.quad(i * segments[1] + j, i * segments[1] + jNext, iNext * segments[1] + jNext,
                         iNext * segments[1] + j);
        }
    }
    return builder.mesh();
}

TriMesh makeSphere(double radius, int subdivisions)
{
    const double golden = 1.61803398874989484820;
    std::vector<Vec3> points;
    for (int s1 : {-1, 1}) {
        for (int s2 : {-1, 1}) {
            points.push_back(Vec3(0.0, s1, s2 * golden).normalized());
            points.push_back(Vec3(s1, s2 * golden, 0.0).normalized());
            points.push_back(Vec3(s2 * golden, 0.0, s1).normalized());
        }
    }
    // The icosahedron's faces are the triples of mutually nearest points.
    const auto near = [&](int a, int b) { return points[a].dot(points[b]) > 0.4; };
    std::vector<std::array<int, 3>> faces;
    for (int a = 0; a < 12; ++a) {
        for (int b = a + 1; b < 12; ++b) {
            for (int c = b + 1; c < 12; ++c) {
                if (!near(a, b) || !near(b, c) || !near(c, a)) continue;
                const bool outward = points[a].dot(points[b].cross(points[c])) > 0.0;
                faces.push_back(outward ? std::array{a, b, c} : std::array{a, c, b});
            }
        }
    }
    for (int pass = 0; pass < subdivisions; ++pass) {
        std::map<std::pair<int, int>, int> middleOf;
        const auto middle = [&](int a, int b) {
            const auto [entry, isNew] = middleOf.try_emplace(std::minmax(a, b), 0);
            if (isNew) {
                points.push_back((points[a] + points[b]).normalized());
                entry->second = static_cast<int>(points.size()) - 1;
            }
            return entry->second;
        };
        std::vector<std::array<int, 3>> finer;
        for (const auto& [a, b, c] : faces) {
            const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }

    Builder builder;
    for (const Vec3& p : points) builder.point(radius * p);
    for (const auto& [a, b, c] : faces) builder.triangle(a, b, c);
    return builder.mesh();
}

TriMesh makeCylinder(double radius, double height, int sectors, int bands)
{
    std::vector<std::pair<double, double>> profile;
    for (int k = 0; k <= bands; ++k) {
        profile.emplace_back(radius, height * (static_cast<double>(k) / bands - 0.5));
    }
    return revolve(profile, -0.5 * height, 0.5 * height, sectors);
}

TriMesh makeCapsule(double radius, double height, int sectors, int rings)
{
    std::vector<std::pair<double, double>> profile;
    for (int half : {-1, 1}) {
        for (int k = 0; k < rings; ++k) {
            const int latitude = half < 0 ? k - rings + 1 : k;  // 0 at the equator
            double s = 0.0, c = 0.0;
            sinCos(0.5 * kPi * latitude / rings, s, c);
            profile.emplace_back(radius * c, half * 0.5 * height + radius * s);
        }
    }
    const double end = 0.5 * height + radius;
    return revolve(profile, -end, end, sectors);
}

}  // namespace scree
