// Bodies as plain data. A body is one index (BodyId) into parallel arrays, ordered by how often
// they are touched: BodyMotion and BodyMass by every impulse, BodyInfo a few times a step.
#pragma once

#include <cstdint>
#include <string>

#include "core/math/types.h"

namespace scree {

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

/// "Cannot be moved" has one meaning: both zero. Static and frozen bodies look alike to a kernel.
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

/// What a step rarely needs.
struct BodyInfo {
    std::string name;  ///< unique in the world
    ShapeId shape = 0;
    MaterialId material = 0;
    BodyKind kind = BodyKind::dynamic;
};

}  // namespace scree
