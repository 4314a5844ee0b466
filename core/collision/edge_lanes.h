// Pairs of edges abreast: which can come to face each other, and how far apart they are. What
// touches is left to faceEdges; here it is told from the many that do not.  [A7, A8]
#pragma once

#include <array>

#include "core/geometry/contact_features.h"
#include "core/math/lanes.h"

namespace scree {

using EightEdges = std::array<const EdgeLine*, kFloatLanes>;

/// Eight edges in one frame.
struct LineLanes {
    FloatLanes3 start, direction, outward;
    FloatLanes length;          ///< [m]
    IntLanes touchBetweenEnds;  ///< alone

    explicit LineLanes(const EightEdges& edges);
    /// Moves them into the frame of another body, where outward is not asked for.
    void place(const RotationLanes& rotation, const FloatLanes3& translation);
};

/// Eight edges in one frame, with what tells from where they can be touched.
struct FacingLanes {
    FloatLanes3 middle, direction, outward;
    FloatLanes3 intoFace[2];
    /// Of the angle around outward within which lie all directions from which they can be touched.
    FloatLanes cosine, sine;
    FloatLanes half;            ///< of their lengths [m]
    IntLanes touchBetweenEnds;  ///< alone

    FacingLanes() = default;
    explicit FacingLanes(const EightEdges& edges);
    /// One of them in all lanes.
    FacingLanes all(int lane) const;
    /// A sphere that holds all eight.
    Ball around() const;
    /// In the frame of another body.
    FacingLanes placed(const Mat3& rotation, const Vec3& translation) const;
};

/// What counts as touching, and how far edges may move before they do.
struct FacingReach {
    double touching;  ///< how far apart the lines of edges are at most that touch [m]
    double way;       ///< that any point moves, and what places are wrong by [m]
    double turn;      ///< of any direction [rad]
};

/// Which of eight pairs of edges, in one frame, can come to touch: those that are near, whose
/// common normal either supports (edgeSupports), and whose lines come to be nearest where edges
/// touch that do so between their ends alone. Most edges beside each other never can.
unsigned mayFace(const FacingLanes& ofFirst, const FacingLanes& ofSecond, const FacingReach& reach);

/// Filters: they err to the side of asking again.
struct EdgeGaps {
    FloatLanes distance;  ///< of the segments, at least [m]
    /// How far any point may move at least before they can have crossed; may be negative [m].
    FloatLanes outside;
    IntLanes mayTouch;  ///< where faceEdges may answer something
};

/// In the frame of the second, whose places are known to `rounding` [m]. Edges deeper in each other
/// than `deepest` do not touch.
EdgeGaps edgeGaps(const LineLanes& ofFirst, const LineLanes& ofSecond, double deepest, double reach,
                  double rounding);

}  // namespace scree
