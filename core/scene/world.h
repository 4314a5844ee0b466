// The world: shapes, materials and bodies in parallel arrays, the order in which bodies are
// processed, and the clock. motion, order, clock, contactMemory and, where bodies are born later,
// bornAt are everything that a step changes; saving and restoring those continues a simulation bit
// for bit.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/shape.h"
#include "core/scene/body.h"
#include "core/scene/contact_memory.h"
#include "core/scene/force_field.h"
#include "core/scene/motion_script.h"
#include "core/scene/pair_rules.h"

namespace scree {

/// Where the simulation stands. A frame is simulated in sub-steps; a frame boundary has subStep = 0
/// and frameTimeDone = 0.
struct Clock {
    std::int64_t frame = 0;      ///< frames since time zero: the frame reached or being left
    std::int64_t subStep = 0;    ///< sub-steps done since that frame
    double frameTimeDone = 0.0;  ///< time simulated since that frame [s]
};

/// What it takes to add a body. Pose and velocity are those of the asset: its own origin and axes
/// place it, and the centre of mass is the solver's own business.
struct BodyDefinition {
    std::string name;
    ShapeId shape = 0;
    MaterialId material = 0;
    BodyKind kind = BodyKind::dynamic;
    Pose worldFromAsset;
    Vec3 velocity = Vec3::Zero();         ///< of the centre of mass [m/s]
    Vec3 angularVelocity = Vec3::Zero();  ///< world axes [rad/s]
    std::optional<double> mass;           ///< [kg]; otherwise density × volume
    CollisionGroups groups;
    Vec3 force = Vec3::Zero();   ///< [N]
    Vec3 torque = Vec3::Zero();  ///< [N m]

    std::shared_ptr<const MotionScript> script;  ///< needed by a keyed body
    std::int64_t keyedFrom = 0;                  ///< frames since time zero; see BodyInfo
    std::int64_t keyedUntil = std::numeric_limits<std::int64_t>::max();

    /// Of a dynamic body that comes later: the earliest frame since time zero.
    struct Birth {
        std::int64_t frame = 0;
        BirthClearance clearance = BirthClearance::wait;
    };
    std::optional<Birth> birth;
};

class World {
public:
    ShapeId addShape(std::shared_ptr<const Shape> shape);
    MaterialId addMaterial(Material material);

    /// Throws Error{badInput} when a body that is not static has no volume (a plane) or a mass that
    /// is not > 0. A keyed body starts where its script is at time zero.
    BodyId addBody(const BodyDefinition& definition);

    std::size_t bodyCount() const { return motion.size(); }
    const Shape& shapeOf(BodyId body) const { return *shapes_[traits[body].shape]; }
    const Material& materialOf(BodyId body) const { return materials_[traits[body].material]; }

    /// Time since the start of the shot, and what it will be `later` [s].
    double time(double later = 0.0) const
    {
        return static_cast<double>(clock.frame) * frameDuration + (clock.frameTimeDone + later);
    }

    /// Where a body with a script is at a time: world from body.
    Pose scriptedPose(BodyId body, double atTime) const;

    /// Makes every body with a script keyed or dynamic, as the frame that the clock stands in asks;
    /// one that becomes keyed just now stands on its script. A function of the clock alone, so that
    /// a resumed run finds the same.  [A55]
    void assignKinds();

    /// The pose an artist would give the asset to stand where the body stands now.
    Pose worldFromAsset(BodyId body) const;

    /// Whether a step may move it by impulses.
    bool isStepped(BodyId body) const
    {
        return mass[body].isMovable() && !contactMemory.isAsleep(body);
    }

    /// Bodies that come later come by beBorn() alone; the others were always there.
    bool isBorn(BodyId body) const { return bornAt[body] >= 0; }

    /// The body enters, at its own place and with its own velocities, at the frame the clock shows.
    void beBorn(const PlannedBirth& birth);

    /// Takes over who has been born when, of a world with the same bodies.
    void restoreBirths(const std::vector<std::int32_t>& bornAtBefore);

    /// What the body has once it is born.
    const BodyMass& massWhenBorn(BodyId body) const;

    /// [kg] whenever it is there and free, be it after its birth or its keys; 0: never.
    double massWhenFree(BodyId body) const;

    std::vector<BodyMotion> motion;
    std::vector<BodyMass> mass;
    std::vector<BodyTraits> traits;
    std::vector<BodyInfo> info;
    std::vector<BodyId> order;  ///< a permutation of the bodies: the order of processing  [A21]
    std::vector<std::int32_t> bornAt;  ///< frames since time zero, or kUnborn, kSkipped
    std::vector<PlannedBirth> births;  ///< of the bodies that come later, in order of their ids
    Clock clock;
    ContactMemory contactMemory;              ///< of method `scree`; empty for `paper`
    double frameDuration = 1.0 / 24.0;        ///< what a frame of the clock means [s]
    std::vector<ForceField> fields;           ///< act on all dynamic bodies
    std::vector<MaterialPair> materialPairs;  ///< exceptions from the rules of combination

private:
    void setKind(BodyId body, BodyKind kind);

    std::vector<std::shared_ptr<const Shape>> shapes_;
    std::vector<Material> materials_;
};

}  // namespace scree
