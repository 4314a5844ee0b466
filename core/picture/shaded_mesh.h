// A mesh made ready for drawing: normals are smooth where the surface is, and sharp at its creases.
#pragma once

#include <cstdint>
#include <vector>

#include "core/picture/scene_description.h"

namespace scree {

/// Sides that meet at a larger angle than this form an edge one should see [degrees]. A ring of ten
/// sides (36°) is meant to be round, an octagonal post (45°) is meant to have edges.
inline constexpr double kCreaseDegrees = 40.0;

/// Points are written once for every group of faces they look smooth in, so that a cube has 24 of
/// them, and for every place of the texture they are seen at.
struct ShadedMesh {
    std::vector<Eigen::Vector3f> points;
    std::vector<Eigen::Vector3f> normals;  // parallel to points
    std::vector<Eigen::Vector2f> uvs;      // parallel to points, or empty
    std::vector<std::uint32_t> indices;    // three for each triangle
    bool isClosed = false;       ///< every edge has its opposite: back faces can never be seen
    Vec3 centre = Vec3::Zero();  ///< of a ball that holds all points
    double radius = 0.0;
};

/// Points equal bit for bit count as one point for the normals, whatever had split them: a seam of
/// the texture is no crease. A normal is the sum of the unit normals of its faces, weighted by
/// their angles at the point, so that it does not depend on how flat regions are cut into
/// triangles.
ShadedMesh shadeMesh(const SceneMesh& mesh, double creaseDegrees = kCreaseDegrees);

/// The same normals for every corner of every triangle, in their order. Triangles with two equal
/// corners have none, and get some direction.
Eigen::Matrix3Xf cornerNormals(const SceneMesh& mesh);

}  // namespace scree
