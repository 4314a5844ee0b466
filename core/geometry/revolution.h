// Is a mesh a ball or a capsule, or about which axes a solid of revolution, as far as facets can
// be?  [A16, A40]
//
// A ball that spins goes nowhere by that, nor does the tread of a wheel: what bounds steps and
// searches by how far a surface moves need not count such turns. Five hundred marbles that ran down
// a slope at 3 m/s asked for 256 steps a frame, and more.
#pragma once

#include "core/geometry/round_facets.h"
#include "core/geometry/tri_mesh.h"
#include "core/math/capsule.h"

namespace scree {

/// For each axis of the frame of the mesh, through its origin: 0 where turns about it leave the
/// surface where it is, but for facets that stand for something round (kFineTurn), else 1.
Vec3 turnsThatShow(const TriMesh& mesh);

/// The capsule or ball about its origin, along an axis of the frame, that a mesh stands for: all
/// facets are round, and all points as far from a segment. Its radius is 0 if there is none.
Capsule capsuleOf(const TriMesh& mesh, const RoundFacets& facets);

}  // namespace scree
