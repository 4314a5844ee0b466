// Who overlaps whom before the first step: there it is a mistake of the shot, or what scattering
// leaves, and contacts alone do not always tell of it.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/collision/interference.h"
#include "core/dynamics/body_pairs.h"
#include "core/geometry/sphere_tree.h"
#include "core/scene/world.h"

namespace scree {

struct StartOverlap {
    BodyId a = -1, b = -1;
    double depth = 0.0;          ///< [m]
    double ratio = 0.0;          ///< of the smaller body's longest box edge [-]
    bool isThroughWall = false;  ///< nearly as deep as anything can be in what is thin of either:
                                 ///< contacts seldom lead out of there
};

/// Tells of pairs of bodies of a world whether they overlap, wherever they may stand. Where a body
/// stands in the place of its copy, or flush with it, every corner of either lies on the surface of
/// the other: so it asks the points inside of both, too.
class OverlapMeasure {
public:
    /// Of the world's shapes; the world must outlive it.
    explicit OverlapMeasure(const World& world);

    /// If they overlap by more than `leastRatio`, or through a wall.
    std::optional<StartOverlap> operator()(BodyPair bodies, const PlacedPair& placed,
                                           double leastRatio) const;

private:
    struct Inside {
        Points points;
        SphereTree tree;

        Inside() = default;
        explicit Inside(const Shape& shape);
    };

    double insideBoth(const PlacedPair& placed, double known) const;
    double insideOfFirst(const Shape& first, const Shape& second, const Pose& secondFromFirst,
                         double deepest) const;

    const World& world_;
    std::map<const Shape*, Inside> inside_;
};

/// Boxes around all bodies; empty, so that they meet nothing, around those not there yet.
std::vector<Aabb> startBoxes(const World& world);

/// Pairs that overlap by more than `leastRatio`, or through a wall however little that is of their
/// size, of which one at least is movable and both are there; the worst ratio first.
std::vector<StartOverlap> findStartOverlaps(const World& world, double leastRatio);

}  // namespace scree
