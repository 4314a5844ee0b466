// What of a mesh can support another body: its corners and its convex edges, each with what tells
// from which directions it can be touched; and the creases in which a corner touches twice. Method
// `scree` makes its contacts of these.  [A7, A8]
//
// Two solids that do not overlap are nearest to each other at a corner and a face, or at two edges;
// so corners of each against the other and pairs of convex edges say all there is to say about
// closely spaced bodies, however coarse the mesh. Samples in a field say less: two facets whose
// edges cross overlap with no sample between them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/sphere_lanes.h"
#include "core/geometry/tri_mesh.h"

namespace scree {

/// An edge where the surface bends outward. Object frame.
struct ConvexEdge {
    std::array<int, 2> ends;         ///< corner indices
    Vec3 start, direction;           ///< unit direction from start [m], [-]
    double length;                   ///< [m]
    std::array<Vec3, 2> faceNormal;  ///< of its two faces
    std::array<Vec3, 2> intoFace;    ///< unit, in each face, away from the edge
    Vec3 outward;                    ///< unit, halfway between the normals of its faces
    std::array<bool, 2> goesOn;      ///< past either end, straight, as another edge
    std::array<bool, 2> endsFine;    ///< there the surface bends outward all around, by a little
};

/// An edge where the surface bends inward, by enough that what slides along one side must be told
/// of the other. Object frame.
struct Crease {
    Vec3 start, direction;           ///< unit direction from start [m], [-]
    double length;                   ///< [m]
    std::array<Vec3, 2> faceNormal;  ///< of its two faces
    std::array<Vec3, 2> intoFace;    ///< unit, in each face, away from the edge
};

/// Cosine of the bend from which an inward edge is a crease. The facets of a ring bend by less.
inline constexpr double kCrease = 0.9;

/// Cosine of the bend from which an outward edge is a blade: about 63 degrees between its faces.
inline constexpr double kBlade = -0.45;

/// What tells how far apart edges are and from where they can be touched, in single precision: one
/// line of the cache.
struct alignas(64) EdgeLine {
    /// As of ConvexEdge: start, length, direction, outward, and into either face. The length is
    /// below zero of an edge that touches between its ends alone.
    std::array<float, 16> numbers;
};

/// Sine of the angle by which surroundings may stand in front of a feature that still counts: the
/// far corners of a block that rocks on an edge are its next supports and must be known before they
/// touch. Anything from 0.2 to 0.5 does.
inline constexpr double kSupportSlack = 0.3;

class ContactFeatures {
public:
    ContactFeatures() = default;
    /// From a solid mesh without equal points, in its object frame.
    explicit ContactFeatures(const TriMesh& mesh);

    const Points& points() const { return points_; }  ///< 3×#V, all of the mesh
    /// Those where at least three faces of different directions meet.
    const std::vector<std::int32_t>& corners() const { return corners_; }
    const std::vector<ConvexEdge>& edges() const { return edges_; }
    bool hasBlades() const { return hasBlades_; }
    /// Whether the mesh is a convex solid of few corners: all of them lie behind all faces, and
    /// there is no cavity.
    bool isConvex() const { return !hullEdges_.empty(); }
    /// Of such a solid one of the edges() on each of its straight lines, which the mesh may cut
    /// into many.
    const std::vector<std::int32_t>& hullEdges() const { return hullEdges_; }
    const std::vector<EdgeLine>& lines() const { return lines_; }  ///< of edges()
    const std::vector<Crease>& creases() const { return creases_; }
    const SphereLaneTree& cornerTree() const { return cornerTree_; }  ///< over corners()
    const SphereLaneTree& edgeTree() const { return edgeTree_; }      ///< over edges()
    const SphereLaneTree& creaseTree() const { return creaseTree_; }  ///< over creases()

    /// Whether the mesh around a corner lies on the positive side of the plane through it with this
    /// normal, give or take the slack: whether something that comes along −normal … +normal can
    /// meet the corner before it meets what surrounds it.
    bool cornerSupports(std::int32_t corner, const Vec3& normal,
                        double slack = kSupportSlack) const;

    /// Into the solid from a corner, halfway between the edges that meet there; not of unit length.
    Vec3 inwardOf(std::int32_t corner) const;

private:
    Points points_;
    std::vector<std::int32_t> corners_;
    std::vector<std::uint32_t> neighbourStart_;  // #V + 1
    std::vector<Vec3> neighbours_;               // unit directions from the corner along its edges
    std::vector<ConvexEdge> edges_;
    std::vector<EdgeLine> lines_;
    std::vector<Crease> creases_;
    std::vector<std::int32_t> hullEdges_;
    bool hasBlades_ = false;

    bool isConvexWithFewCorners() const;
    void findHullEdges();
    SphereLaneTree cornerTree_, edgeTree_, creaseTree_;
};

/// Whether what crosses the line of an edge past an end of it does not touch it: what comes next
/// there speaks.
inline bool touchesBetweenEndsAlone(const ConvexEdge& edge)
{
    return (edge.goesOn[0] || edge.endsFine[0]) && (edge.goesOn[1] || edge.endsFine[1]);
}

/// ContactFeatures::cornerSupports for an edge; `normal` points into its solid.
bool edgeSupports(const ConvexEdge& edge, const Vec3& normal, double slack = kSupportSlack);

}  // namespace scree
