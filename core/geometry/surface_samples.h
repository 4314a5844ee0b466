// The points of a surface that are tested against other bodies: its vertices and, where edges are
// long, the deepest points of its edges.  [A7, A8, A13]
//
// Sample ids are stable: vertex v has id v; the points found on edge e have ids #V + 3 e + 0 … 2.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/sphere_tree.h"
#include "core/geometry/tri_mesh.h"
#include "core/math/rotation.h"

namespace scree {

struct SurfaceSamples {
    Points vertices;                        // 3×#V, object frame
    std::vector<std::array<int, 2>> edges;  // vertex indices; empty when edges are not sampled
    std::vector<double> edgeLengths;        // [m]
    SphereTree vertexTree, edgeTree;

    bool isEmpty() const { return vertices.cols() == 0; }
};

/// Samples of a mesh without equal points. Edges inside a flat region are left out: what touches
/// the region there, touches it with a vertex or an edge of its own.
SurfaceSamples makeSurfaceSamples(const TriMesh& mesh, bool withEdges);

/// Edges sharper than this call for true normals [rad].  [A6]
inline constexpr double kSharpEdge = 40.0 * kPi / 180.0;

/// The sharpest dihedral angle of the mesh, as the angle between the two normals [rad].
double sharpestEdge(const TriMesh& mesh);

/// How many edges are sharper than `angle` [rad].
int countSharperEdges(const TriMesh& mesh, double angle);

double longestEdge(const TriMesh& mesh);

}  // namespace scree
