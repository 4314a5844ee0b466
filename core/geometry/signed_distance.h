// Signed distance to a solid: a lattice of nodes, and near the surface the mesh itself.  [A4, A5]
//
// A few solids have a formula for it and need neither (exact_solid.h).
//
// A trilinear grid rounds edges: where a box's true distance is 0 it reads +h/4 at an edge and +0.4
// h at a corner, and a stack of ten cubes on such a field falls over at any affordable resolution.
// So the grid only filters. Its nodes are exact and distance is 1-Lipschitz, hence the interpolated
// value is off by at most the weighted mean of the distances to the corners, which is no more than
// the root of the mean of their squares, √3/2 h at most: wherever it reads less than that, the true
// distance is computed from the few triangles that can be closest in that cell.
//
// Cost on the 320-triangle ring (tests/benchmarks/distance_benchmark.cpp): grid 8 ns a point,
// refined 20 ns anywhere in its box and 57 ns at the surface.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry/distance_field.h"
#include "core/geometry/exact_solid.h"
#include "core/geometry/triangle_distance.h"
#include "core/math/aabb.h"

namespace scree {

/// Around here the closest point of the surface lies within one face, or on one of two.
struct FacePlace {
    Vec3 centre = Vec3::Zero();               ///< [m]
    double squaredRadius = -1.0;              ///< negative: nowhere [m²]
    std::array<std::uint32_t, 2> faces = {};  ///< ascending
    std::uint32_t faceCount = 0;

    bool holds(const Vec3& point) const { return (point - centre).squaredNorm() < squaredRadius; }
};

class SignedDistance {
public:
    SignedDistance() = default;

    /// A formula instead of a lattice, exact everywhere. `spacing` [m] is the length that searches
    /// in the field take for small.  [A9]
    explicit SignedDistance(const ExactSolid& solid, double spacing = 0.0);

    /// From a solid mesh and its finished field. `refined` switches the exact distance near the
    /// surface on; without it values are purely trilinear, as in the paper.
    SignedDistance(const TriMesh& mesh, DistanceField field, bool refined);

    /// The formula; null where there is a lattice.
    const ExactSolid* solid() const { return solid_ ? &*solid_ : nullptr; }
    double spacing() const { return solid_ ? solidSpacing_ : field_.nodes.layout.spacing; }
    const Aabb& domain() const { return domain_; }
    const Aabb& surfaceBox() const { return surfaceBox_; }
    /// Without nodes where there is a formula.
    const DistanceField& field() const { return field_; }
    /// What nodes, blocks, lists and triangles take [bytes].
    std::size_t byteCount() const;

    /// Signed distance [m]: this decides inside, depth and rank.
    double value(const Vec3& point) const;

    /// Trilinear value; outside the domain the clamped value plus the way there, an upper bound.
    double gridValue(const Vec3& point) const;

    /// Never more than the true signed distance, and equal to it within the refinement band.
    double lowerBound(const Vec3& point) const { return lowerBound(point, gridValue(point)); }
    /// The same where the trilinear value is known already.
    double lowerBound(const Vec3& point, double gridValue) const;

    /// True when nothing of the solid can lie within `radius` of the point: a quick filter that may
    /// say no too often but never yes wrongly.
    bool isClearOf(const Vec3& point, double radius) const;

    /// Gradient of the trilinear field by central differences over one spacing, not normalised; at
    /// the clamped point when outside the domain. Short (< 0.1) near the medial axis.  [A5]
    Vec3 gridGradient(const Vec3& point) const;

    /// The same of the one cell that the point lies in: a sixth of the work, but it jumps between
    /// cells.
    Vec3 cellGradient(const Vec3& point) const;

    /// Signed distance with its slope: the exact gradient (unit) near the surface, central
    /// differences of the trilinear field elsewhere.
    struct Sloped {
        double value;
        Vec3 gradient;
    };
    Sloped sloped(const Vec3& point) const;

    /// Where around a point the faces closest to it are the closest; only where
    /// isRefined(gridValue).
    FacePlace placeAround(const Vec3& point, double gridValue) const;
    /// The same bits as without the place, which must hold the point.
    double value(const Vec3& point, const FacePlace& place) const;
    Sloped sloped(const Vec3& point, const FacePlace& place) const;

    /// The closest point of the surface and what it lies on.
    struct Nearest {
        double value;  ///< signed distance [m]
        Vec3 point;    ///< [m]
        bool onFace;   ///< inside a face: else on an edge or a corner
        Vec3 normal;   ///< of the face [-]
        std::uint32_t face = 0;
    };
    /// Only for points where |gridValue| < refinementBand().
    Nearest nearest(const Vec3& point) const;

    /// Of one face, unsigned [m].
    double distanceToFace(std::uint32_t face, const Vec3& point) const;

    /// For points outside that are farther away than that: a place of the surface that is the
    /// closest, or hardly farther, sought where the slope of the field leads. None where it leads
    /// nowhere, as halfway between two walls.
    std::optional<Nearest> nearestFromAfar(const Vec3& point) const;

    /// Never less than the true distance.
    double upperBound(const Vec3& point) const;

    /// The exact signed distance, from the triangles of the cell; only for points where |gridValue|
    /// < refinementBand().
    double exact(const Vec3& point) const;
    double refinementBand() const { return band_; }
    /// Whether value() is exact() where the grid says this.
    bool isRefined(double gridValue) const { return !solid_ && std::abs(gridValue) < band_; }

    /// Appends the faces of the cell that pass within `tolerance` of the point (at most a few).
    void facesNear(const Vec3& point, double tolerance, std::vector<NearFace>& faces) const;

private:
    /// What every search reads; what only some answers need lies apart.
    struct Face {
        TriangleCorners corners;
        Vec3 normal;
        EdgeProducts edges;
    };
    struct Border {
        Vec3 normal[6];  // by TriangleFeature: angle-weighted at corners, summed at edges
        double angle[3];
    };

    struct Closest {
        std::uint32_t face = 0;
        TriangleFeature feature = TriangleFeature::face;
        Vec3 point = Vec3::Zero();
        double squaredDistance = 1e300;
    };

    void buildFaces(const TriMesh& mesh);
    Vec3 clamped(const Vec3& point) const
    {
        return point.cwiseMax(domain_.min).cwiseMin(domain_.max);
    }
    /// The faces that can be closest to some point of a cell, those first that are nearest to its
    /// centre; how far a point is from there tells when none of the others can matter.
    struct CellFaces {
        std::span<const ListedFace> faces;
        double fromCentre;  ///< of the point [m]
    };
    CellFaces facesFor(const Vec3& point, const Vec3& placeInCell) const;
    Closest closestInCell(const Vec3& point, const Vec3& placeInCell) const;
    Closest closestOf(const FacePlace& place, const Vec3& point) const;
    bool isCloser(std::uint32_t face, const Vec3& point, Closest& best) const;
    Sloped slopedAt(const Closest& closest, const Vec3& point) const;
    const Vec3& normalAt(const Closest& closest) const;
    double signedValue(const Closest& closest, const Vec3& point) const;
    Nearest nearestOf(const Closest& closest, double value) const;

    std::optional<ExactSolid> solid_;
    double solidSpacing_ = 0.0;
    DistanceField field_;
    Aabb domain_;        // of the nodes
    Aabb surfaceBox_;    // of the mesh
    double band_ = 0.0;  // 0: never refine
    std::vector<Face> faces_;
    std::vector<Border> borders_;  // of these
};

}  // namespace scree
