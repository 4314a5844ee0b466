// The world: shapes, materials and bodies in parallel arrays, the order in which bodies are
// processed, and the clock. motion, order, clock and, where bodies are born later, bornAt are
// everything that a step changes; saving and restoring those continues a simulation bit for bit.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/shape.h"
#include "core/scene/body.h"
#include "core/scene/contact_memory.h"

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

    /// Throws Error{badInput} when a dynamic body has no volume (a plane) or a mass that is not >
    /// 0.
    BodyId addBody(const BodyDefinition& definition);

    std::size_t bodyCount() const { return motion.size(); }
    const Shape& shapeOf(BodyId body) const { return *shapes_[info[body].shape]; }
    const Material& materialOf(BodyId body) const { return materials_[info[body].material]; }

    /// The pose an artist would give the asset to stand where the body stands now.
    Pose worldFromAsset(BodyId body) const;

    /// Bodies that come later come by beBorn() alone; the others were always there.
    bool isBorn(BodyId body) const { return bornAt[body] >= 0; }

    /// The body enters, at its own place and with its own velocities, at the frame the clock shows.
    void beBorn(const PlannedBirth& birth);

    /// Takes over who has been born when, of a world with the same bodies.
    void restoreBirths(const std::vector<std::int32_t>& bornAtBefore);

    /// What the body has once it is born.
    const BodyMass& massWhenBorn(BodyId body) const;

    std::vector<BodyMotion> motion;
    std::vector<BodyMass> mass;
    std::vector<BodyInfo> info;
    std::vector<BodyId> order;  ///< a permutation of the bodies: the order of processing  [A21]
    std::vector<std::int32_t> bornAt;  ///< frames since time zero, or kUnborn, kSkipped
    std::vector<PlannedBirth> births;  ///< of the bodies that come later, in order of their ids
    Clock clock;
    ContactMemory contactMemory;  ///< of method `scree`; empty for `paper`

private:
    std::vector<std::shared_ptr<const Shape>> shapes_;
    std::vector<Material> materials_;
};

}  // namespace scree
