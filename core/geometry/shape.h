// A shape: everything that many bodies share. Mesh and distance field describe the same solid in
// the object frame, whose origin is the centre of mass and whose axes are principal.  [A1–A6]
//
// The mesh supplies sample points, true normals and mass; the field supplies inside tests, depth
// and smooth normals. A plane is a shape too: an exact half space without samples, volume or box.
// Spheres, boxes and cylinders may be exact as well; then the mesh is only what is drawn.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "core/geometry/contact_features.h"
#include "core/geometry/hollow_facets.h"
#include "core/geometry/inner_ball.h"
#include "core/geometry/level_set_remesh.h"
#include "core/geometry/mass_properties.h"
#include "core/geometry/mesh_deviation.h"
#include "core/geometry/mesh_repair.h"
#include "core/geometry/round_facets.h"
#include "core/geometry/round_rims.h"
#include "core/geometry/signed_distance.h"
#include "core/geometry/smooth_surface.h"
#include "core/geometry/surface_rays.h"
#include "core/geometry/surface_samples.h"
#include "core/geometry/tri_mesh.h"
#include "core/math/aabb.h"
#include "core/math/capsule.h"

namespace scree {

class ShapeStore;

/// Where contact normals come from.  [A5, A6]
enum class NormalMode {
    automatic,    ///< true when any edge is sharper than 40°, else smooth
    smooth,       ///< gradient of the distance field
    trueNormals,  ///< of the mesh, by ray casts along that gradient
};

/// What decides inside and depth near the surface.  [A4]
enum class FieldMode {
    refined,  ///< exact distance to the mesh
    grid,     ///< the trilinear field alone, as in the paper
};

struct ShapeSettings {
    std::optional<int> resolution;  ///< voxels along the longest box edge; default from thickness
    std::optional<double> voxel;    ///< [m], instead of resolution
    std::optional<std::size_t>
        enoughNodes;  ///< how many the default need not exceed, however thin the walls are; where
                      ///< it is not told, the default is refused above 512 along the longest edge
    FieldStorage storage = FieldStorage::automatic;
    NormalMode normals = NormalMode::automatic;
    FieldMode field = FieldMode::refined;
    std::optional<bool>
        edgeSamples;  ///< [A8]; otherwise on when edges are long against the thickness
    MeshRepair repair = MeshRepair::none;  ///< of a mesh that is no solid  [A1]
    double repairThickness = 0.0;  ///< of MeshRepair::shell and solidify; of MeshRepair::ground
                                   ///< below its lowest point, of the walls of MeshRepair::room; of
                                   ///< these two 0: as they choose [m]
};

/// What was done to the artist's mesh before it became a solid.
struct ShapeRepairs {
    HarmlessRepairs harmless;
    MeshRepair asked = MeshRepair::none;  ///< that the shot asked for
    double voxel = 0.0;                   ///< of the remeshing [m]
    Vec3 groundUp = Vec3::Zero();         ///< where the sheet of a ground looks
    double behind = 0.0;  ///< what was put behind what is drawn: a ground's depth below its lowest
                          ///< point, the walls of a room at their thinnest, of a sheet all [m]
    bool hasCollisionMesh = false;   ///< what collides was made from another mesh than is drawn
    MeshDeviation drawnToColliding;  ///< of the two, in the artist's frame; 0 where they are one
};

struct Shape {
    std::string name;
    bool isPlane = false;
    bool samplesMove =
        false;  ///< exact sphere or cylinder: its samples are no material points  [A9]

    TriMesh assetMesh;        ///< what is drawn, as the artist made it, scale baked in [m]; empty
                              ///< for a plane
    ShapeRepairs repairs;     ///< between assetMesh and mesh
    Pose bodyFromAsset;       ///< object frame from the artist's frame
    MassProperties unitMass;  ///< for density 1 kg/m³, in the object frame

    TriMesh mesh;                   ///< in the object frame [m]
    Aabb box;                       ///< of the mesh, object frame
    double boundingRadius = 0.0;    ///< of the mesh about the centre of mass [m]
    Vec3 axisRadii = Vec3::Zero();  ///< of the mesh about each axis of the object frame [m]
    /// How far it is through the solid from its faces, inward: the first percentile by area [m].
    /// [A16], which asks for the largest balls in it at the samples instead.
    double innerThickness = 0.0;
    double commonThickness = 0.0;  ///< tenth percentile of it: without edges; of a plane endless
    Ball innerBall;                ///< about as large as any in the solid, object frame [m]
    bool usesTrueNormals = false;
    Vec3 turnsThatShow = Vec3::Ones();  ///< by axis of the object frame  [revolution.h]
    Capsule capsule;                    ///< that it touches as, or ball; else of radius 0

    SignedDistance distance;   ///< grid, exact refinement, or plane
    SurfaceSamples samples;    ///< empty for a plane and where samples move
    ContactFeatures features;  ///< empty for a plane and round exact solids
    SurfaceRays rays;          ///< empty for a plane and exact solids
    SmoothSurface smooth;      ///< empty for sharp meshes, planes and exact solids  [A40]
    RoundFacets roundFacets;   ///< empty for the same
    RoundRims rims;            ///< empty where there are no features
    HollowFacets hollows;      ///< empty for planes and exact solids too

    /// No place of the mesh lies farther below what it stands for than this [m].
    double bulge() const { return std::max(roundFacets.bulge(), rims.bulge()); }

    /// An exact sphere, or a mesh that stands for a capsule or a ball and is fine enough: with
    /// method `scree` it touches others of its kind as that, and a ball all bodies. Five hundred
    /// marbles of 1280 triangles took fifty times as long as meshes.
    bool isCapsule() const { return capsule.radius > 0.0; }
    bool isBall() const { return isCapsule() && capsule.isBall(); }

    bool showsAllTurns() const { return turnsThatShow == Vec3::Ones(); }
    /// What of a turn, or of a spin, moves the surface, in the world of a body that stands so.
    Vec3 shownOf(const Vec3& turn, const Quat& orientation) const
    {
        if (showsAllTurns()) return turn;
        return orientation * turnsThatShow.cwiseProduct(orientation.conjugate() * turn);
    }

    // Those of a plane have no end [m].
    double thickness() const { return isPlane ? kEndless : innerThickness; }
    double longestEdge() const { return isPlane ? kEndless : box.longestEdge(); }

    static constexpr double kEndless = std::numeric_limits<double>::infinity();
};

/// A world box around a placed shape; a plane's is everything. Hardly larger than needed for what
/// is long, flat or round.
Aabb boxAt(const Shape& shape, const Pose& pose);

/// Builds mass, field, samples and rays from a closed mesh in the artist's frame, lengths in
/// metres; what can be repaired without harm is. Throws Error{badInput} naming `name` when the mesh
/// is not a solid [A1], has no volume [A2] or is too thin for the largest allowed resolution, 512
/// [A4]: the message says which would do. A field that `store` has is not
/// built again, and one that is built is kept there.
std::shared_ptr<const Shape> buildMeshShape(const std::string& name, const TriMesh& assetMesh,
                                            const ShapeSettings& settings = {},
                                            ShapeStore* store = nullptr);

/// The same from a mesh that is only drawn and one that collides in its stead, both in the artist's
/// frame. What is drawn need be no solid, but a surface.
std::shared_ptr<const Shape> buildMeshShape(const std::string& name, const TriMesh& drawn,
                                            const TriMesh& colliding, const ShapeSettings& settings,
                                            ShapeStore* store);

/// A sphere, box or cylinder that collides as the formula says, not as a mesh: field, normals and
/// mass are exact. `mesh`, in the solid's own frame, is what is drawn; of a box it also supplies
/// the samples. Of the settings only edgeSamples matters, and only to a box.  [A9]
std::shared_ptr<const Shape> buildExactShape(const std::string& name, const ExactSolid& solid,
                                             const TriMesh& mesh,
                                             const ShapeSettings& settings = {});

/// The half space below the plane through its own origin with normal +y; exact.  [A9]
std::shared_ptr<const Shape> buildPlaneShape(const std::string& name);

/// Pose of a plane body: its origin at `point`, its +y along `normal` (not zero).
Pose worldFromPlane(const Vec3& point, const Vec3& normal);

}  // namespace scree
