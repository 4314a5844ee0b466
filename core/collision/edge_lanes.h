// Pairs of edges abreast: which can come to face each other, and how far apart they are. What
// touches is left to faceEdges; here it is told from the many that do not.  [A7, A8]
#pragma once

#include <array>

#include "core/geometry/contact_features.h"
#include "core/math/lanes.h"

namespace scree {

/// Four segments in the frame of the second shape.
struct SegmentLanes {
    Lanes3 start, direction;
    Lanes length;  ///< [m]

    template <class Segment>
    explicit SegmentLanes(const std::array<const Segment*, kLanes>& s)
        : start(lanesOf(s[0]->start, s[1]->start, s[2]->start, s[3]->start)),
          direction(lanesOf(s[0]->direction, s[1]->direction, s[2]->direction, s[3]->direction)),
          length{s[0]->length, s[1]->length, s[2]->length, s[3]->length}
    {
    }
};

/// Four edges of the second shape.
struct EdgeLanes : SegmentLanes {
    Lanes3 outward;

    explicit EdgeLanes(const std::array<const ConvexEdge*, kLanes>& e)
        : SegmentLanes(e),
          outward(lanesOf(e[0]->outward, e[1]->outward, e[2]->outward, e[3]->outward))
    {
    }
};

/// Eight edges in one frame, with what tells from where they can be touched.
struct FacingLanes {
    FloatLanes3 middle, direction, outward;
    FloatLanes3 intoFace[2];
    FloatLanes half;  ///< of their lengths [m]

    void set(int lane, const ConvexEdge& edge)
    {
        middle.set(lane, edge.start + 0.5 * edge.length * edge.direction);
        direction.set(lane, edge.direction);
        outward.set(lane, edge.outward);
        for (int k : {0, 1}) intoFace[k].set(lane, edge.intoFace[k]);
        half[lane] = static_cast<float>(0.5 * edge.length);
    }
    /// One of them in all lanes.
    FacingLanes all(int lane) const;
    /// A sphere that holds all eight.
    Sphere around() const;
    /// In the frame of another body.
    FacingLanes placed(const Mat3& rotation, const Vec3& translation) const;
};

/// Which of eight pairs of edges, in one frame, can come to touch while nothing moves by more than
/// `farthest` - no point, and no direction by more than `turn` [rad]: those that are near, and
/// whose common normal either supports (edgeSupports), give or take that turn. Most edges beside
/// each other never can.
unsigned mayFace(const FacingLanes& ofFirst, const FacingLanes& ofSecond, double farthest,
                 double turn);

struct EdgeGaps {
    Lanes distance;  ///< of the segments; where they are nearly parallel a hair less [m]
    /// How far any point may move before they can have crossed; may be negative [m].
    Lanes outside;
    LaneMask mayTouch;  ///< where faceEdges may answer something
};

/// Edges deeper in each other than `deepest` do not touch.
EdgeGaps edgeGaps(const SegmentLanes& ofFirst, const EdgeLanes& ofSecond, double deepest,
                  double reach);

}  // namespace scree
