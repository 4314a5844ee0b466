// What two bodies of a world are to each other, whatever pass asks.
#pragma once

#include <optional>

#include "core/collision/placed_pair.h"
#include "core/dynamics/settings.h"
#include "core/scene/body_pair.h"
#include "core/scene/world.h"

namespace scree {

/// What two surfaces are to each other.
struct PairSurface {
    double friction, restitution;  ///< [-]
    RollingFriction rolling;
};

/// By the rules of combination, unless the world has an exception for the two materials.  [A27]
PairSurface surfaceOf(const World& world, const StepSettings& settings, BodyPair bodies);

/// Whether neither group passes through the other.  [A57]
bool acceptEachOther(const World& world, BodyPair bodies);

/// Whether the group of `body` keeps it from being moved by `other`.  [A57]
bool isUnmovedBy(const World& world, BodyId body, BodyId other);

/// Whether groups let the pair collide, and anything could come of it.  [A57]
bool mayCollide(const World& world, BodyPair bodies);

/// Out of the plane, where one of a pair is such; nothing where none is.
std::optional<Vec3> normalOfPlane(const World& world, BodyPair bodies);

/// Of a body where it is; that of a plane is all of space.
Aabb boxOf(const World& world, BodyId body);

/// Bounding radius of the smaller body of a pair [m].
double smallerRadius(const World& world, BodyId a, BodyId b);

/// Longest box edge of the smaller body of a pair [m].
double smallerEdge(const World& world, BodyId a, BodyId b);

/// The share of that edge that a depth is [-].
double overlapRatio(const World& world, BodyPair bodies, double depth);

/// What overlaps most of many pairs.
struct WorstOverlap {
    double depth = 0.0;     ///< the deepest of all [m], ≥ 0
    double ratio = 0.0;     ///< the largest of all, by overlapRatio
    BodyId a = -1, b = -1;  ///< the first pair of that ratio

    void include(const World& world, BodyPair bodies, double depthOfPair);
    void include(const WorstOverlap& other);
};

/// Two bodies where they are.
PlacedPair placePair(const World& world, BodyPair bodies);

}  // namespace scree
