#include "core/dynamics/gaps/gap_pace.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/body_pairs.h"
#include "core/geometry/sphere_tree.h"

namespace scree {
namespace {

/// Around the points of either body that may touch the other when nothing moves farther than `way`
/// before: what their bounding spheres have in common. Nothing bounds a plane.
Ball meetingPlace(const World& world, BodyPair bodies, double way)
{
    const Shape &shapeA = world.shapeOf(bodies.a), &shapeB = world.shapeOf(bodies.b);
    const Ball a{world.motion[bodies.a].position, shapeA.boundingRadius};
    const Ball b{world.motion[bodies.b].position, shapeB.boundingRadius};
    if (shapeA.isPlane) return b;
    if (shapeB.isPlane) return a;
    // They meet in a circle, in the plane that divides the line from A to B at this share.
    const Vec3 fromAToB = b.centre - a.centre;
    const double square = fromAToB.squaredNorm();
    const double radiusA = a.radius + way, radiusB = b.radius + way;
    const double share = 0.5 * (1.0 + (radiusA * radiusA - radiusB * radiusB) / square);
    if (!(share > 0.0)) return a;
    if (!(share < 1.0)) return b;
    const double ofCircle = radiusA * radiusA - share * share * square;
    return {a.centre + share * fromAToB, std::sqrt(std::max(ofCircle, 0.0))};
}

/// What of a turn of a body moves its surface.
Vec3 shownOf(const World& world, BodyId body, const Vec3& turn)
{
    return world.shapeOf(body).shownOf(turn, world.motion[body].orientation);
}

}  // namespace

GapPace paceOf(const World& world, const GapScratch& scratch, BodyId body, double dt)
{
    const GapBody& b = scratch.bodies[body];
    const Shape& shape = world.shapeOf(body);
    GapPace pace{b.velocity.norm(), 0.0, b.pull.norm()};
    if (!shape.isPlane) {
        const double spin = shownOf(world, body, b.spin).norm() +
                            dt * shownOf(world, body, b.inverseInertia * b.torque).norm();
        pace.bySpin = spin * shape.boundingRadius;
    }
    return pace;
}

double farthestApproach(const World& world, BodyPair bodies, const RigidMotion& ofA,
                        const RigidMotion& ofB)
{
    const Shape &shapeA = world.shapeOf(bodies.a), &shapeB = world.shapeOf(bodies.b);
    const Vec3 shownA = shownOf(world, bodies.a, ofA.turn);
    const Vec3 shownB = shownOf(world, bodies.b, ofB.turn);
    const double byTurns =
        shownA.norm() * shapeA.boundingRadius + shownB.norm() * shapeB.boundingRadius;
    const double anywhere = (ofA.shift - ofB.shift).norm() + byTurns;
    const Ball place = meetingPlace(world, bodies, anywhere);
    // What rolls on another goes with it where they meet. All of a body may meet a plane, and of
    // that its own turns move what shows.
    const Vec3& turnA = shapeB.isPlane ? shownA : ofA.turn;
    const Vec3& turnB = shapeA.isPlane ? shownB : ofB.turn;
    const Vec3 a = ofA.shift + turnA.cross(place.centre - world.motion[bodies.a].position);
    const Vec3 b = ofB.shift + turnB.cross(place.centre - world.motion[bodies.b].position);
    const double byTurnThere = (turnA - turnB).norm() * place.radius;
    const std::optional<Vec3> normal = normalOfPlane(world, bodies);
    if (!normal) return std::min(anywhere, (a - b).norm() + byTurnThere);
    // Told of what is ahead of the place it rolls on, a can braked at 1 rad a step. To tell others
    // less of a plane brings nothing.
    const Shape& other = shapeA.isPlane ? shapeB : shapeA;
    if (other.showsAllTurns()) return (a - b).norm() + byTurnThere;
    return std::abs(normal->dot(a - b)) + byTurnThere;
}

}  // namespace scree
