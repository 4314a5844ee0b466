// Bodies as plain data. A body is one index (BodyId) into parallel arrays, ordered by how often
// they are touched: BodyMotion and BodyMass by every impulse, BodyTraits by every pair, BodyInfo a
// few times a step.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include "core/math/types.h"

namespace scree {

class MotionScript;

using BodyId = std::int32_t;
using ShapeId = std::int32_t;
using MaterialId = std::int32_t;

/// Resistance to rolling and to spinning on the spot. A lever arm b brakes with the couple b times
/// the normal force; the paper's own coefficients take spin away by normal impulse, whatever the
/// inertia.  [A49]
struct RollingFriction {
    double rolling = 0.0;      ///< lever arm [m]
    double spinning = 0.0;     ///< lever arm [m]
    double rawRolling = 0.0;   ///< the paper's [1/(kg m)]
    double rawSpinning = 0.0;  ///< the paper's [1/(kg m)]

    bool isNone() const
    {
        return rolling == 0.0 && spinning == 0.0 && rawRolling == 0.0 && rawSpinning == 0.0;
    }
};

/// How a surface behaves; how it looks is render's business.
struct Material {
    std::string name;
    double density = 1000.0;   ///< [kg/m³]
    double friction = 0.5;     ///< Coulomb coefficient [-]
    double restitution = 0.0;  ///< [-], 0 … 1
    RollingFriction rolling = {};
};

enum class BodyKind : std::uint8_t {
    dynamic,  ///< moved by forces and impulses
    fixed,    ///< never moves: infinite mass  [A53]
    keyed,    ///< follows its script, whatever hits it: infinite mass  [A54]
};

/// The state: all that changes in time. Angular momentum, not angular velocity, is the state,
/// because it is what torque-free flight conserves.  [A0]
struct BodyMotion {
    Vec3 position = Vec3::Zero();         ///< centre of mass, world [m]
    Quat orientation = Quat::Identity();  ///< world from body
    Vec3 velocity = Vec3::Zero();         ///< [m/s]
    Vec3 angularMomentum = Vec3::Zero();  ///< about the centre of mass, world axes [kg m²/s]

    Pose worldFromBody() const { return {position, orientation}; }
};

/// "Cannot be moved" has one meaning: no inverse mass. Static, keyed and frozen bodies look alike
/// to a kernel. A keyed body keeps its inverse inertia, which no impulse sees, because its spin is
/// kept as angular momentum like everybody's: so it is released with the spin it has.  [A55]
struct BodyMass {
    double inverseMass = 0.0;            ///< [1/kg]
    Vec3 inverseInertia = Vec3::Zero();  ///< of the principal moments, body axes [1/(kg m²)]

    bool isMovable() const { return inverseMass > 0.0; }
};

/// What to do while the place of a birth is taken.
enum class BirthClearance : std::uint8_t {
    wait,  ///< try again at the next frame
    skip,  ///< the body never comes
    fail,  ///< the run is over
};

/// A body that is not there from the start. Until it is born it has its place in all arrays (so
/// that ids and order never change) but no mass and no box: nothing moves it and nothing meets it.
struct PlannedBirth {
    BodyId body = 0;
    std::int64_t frame = 0;  ///< the earliest, in frames since time zero
    BirthClearance clearance = BirthClearance::wait;
    BodyMass mass;  ///< what it will have
};

/// Values of World::bornAt that are no frames.
inline constexpr std::int32_t kUnborn = -1;   ///< not yet
inline constexpr std::int32_t kSkipped = -2;  ///< never

/// With whom a body collides: each body is in one group, given as a bit.  [A57]
struct CollisionGroups {
    std::uint64_t group = 1;
    std::uint64_t collidesWith = ~std::uint64_t{0};  ///< both of a pair must accept the other
    std::uint64_t unmovedBy = 0;  ///< to these the body is of infinite mass: it moves them only
};

/// What every pair is asked about: small, so that those of a large world stay in the cache.
struct BodyTraits {
    ShapeId shape = 0;
    MaterialId material = 0;
    CollisionGroups groups;
};

/// What a step rarely needs.
struct BodyInfo {
    std::string name;  ///< unique in the world
    BodyKind kind = BodyKind::dynamic;
    double freeInverseMass = 0.0;  ///< [1/kg] while it is dynamic; 0 for what is always static
    Vec3 force = Vec3::Zero();     ///< constant, at the centre of mass [N]
    Vec3 torque = Vec3::Zero();    ///< constant, world axes [N m]

    // Its motion while it is keyed: in the frames keyedFrom … keyedUntil − 1 since time zero.
    std::shared_ptr<const MotionScript> script;  ///< of the asset; null: never keyed
    std::int64_t keyedFrom = 0;
    std::int64_t keyedUntil = std::numeric_limits<std::int64_t>::max();
};

}  // namespace scree
