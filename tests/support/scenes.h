// Small worlds for tests of a part of the method, and what is measured of them; the experiments
// themselves are in tools/verify.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/dynamics/settings.h"
#include "core/geometry/shape.h"
#include "core/math/rotation.h"
#include "core/scene/world.h"

namespace scree::test {

/// Settings of the experiments: g = 9.8 m/s², seed 1.
StepSettings experimentSettings();

/// The same with method `scree`.
StepSettings screeSettings();

/// A body's friction and restitution are those of its pairs with everything else in these scenes.
MaterialId addMaterial(World& world, double friction, double restitution, double density = 1.0);

/// The half space under a plane through `point` with normal `normal`.
BodyId addPlane(World& world, MaterialId material, const Vec3& point = Vec3::Zero(),
                const Vec3& normal = Vec3::UnitY());

/// A box of the given size with `segments` quads along each edge; built once for equal arguments.
std::shared_ptr<const Shape> boxShape(const Vec3& size, int segments);

/// Solids that collide as their formula says.  [A9]
std::shared_ptr<const Shape> exactSphere(double radius);
std::shared_ptr<const Shape> exactBox(const Vec3& size, int segments);
std::shared_ptr<const Shape> exactCylinder(double radius, double height);

/// A solid of a flat outline, all of which is seen from `centre`, thick along z.
std::shared_ptr<const Shape> extruded(const std::vector<Eigen::Vector2d>& outline, double thick,
                                      const Eigen::Vector2d& centre = Eigen::Vector2d::Zero());

/// Solids with points, hollows and edges sharper than square, half a metre or so in size: a star
/// with five points, an outline like that of a gear; an angle of two bars; a three-sided prism; a
/// thin splinter.
std::shared_ptr<const Shape> starShape();
std::shared_ptr<const Shape> angleShape();
std::shared_ptr<const Shape> prismShape();
std::shared_ptr<const Shape> splinterShape();

/// A bin in one mesh, open above, with as many walls as asked for and its floor at y = 0, all of
/// them kBinHalf from its middle there; the first wall stands in +x. They lean out by `flare` up to
/// `height` [m].
inline constexpr double kBinHalf = 0.5;
std::shared_ptr<const Shape> binShape(double flare, double height, int walls = 4);

BodyId addBody(World& world, std::shared_ptr<const Shape> shape, MaterialId material,
               const Pose& worldFromAsset, double mass = 1.0, const Vec3& velocity = Vec3::Zero(),
               const Vec3& angularVelocity = Vec3::Zero());

BodyId addFixed(World& world, MaterialId material, std::shared_ptr<const Shape> shape,
                const Pose& worldFromAsset);

/// A body that a script moves; keys in seconds since the first frame.
BodyId addKeyedBody(World& world, std::shared_ptr<const Shape> shape, MaterialId material,
                    const std::vector<MotionKey>& keys, KeyInterpolation interpolation);

/// Cubes of 1 m and 1 kg, eight corners each, one on the other on the ground but for a centimetre
/// each way; the last and top one weighs `topMass`.
World stackOfCubes(int count, double topMass);

/// A wall of bricks, laid dry in stretcher bond, that leans over on its lowest layer.
World leaningWall(int columns, int layers);

Vec3 angularVelocityOf(const World& world, BodyId body);

/// Largest displacement of any vertex of the body between two worlds [m].
double largestVertexShift(const World& before, const World& after, BodyId body);

/// How deep the edges of A lie in B, seen in so many places of each: what contacts tell of an
/// overlap should be about as much [m].
double deepestOfEdges(const Shape& a, const Shape& b, const Pose& bFromA, int places);

}  // namespace scree::test
