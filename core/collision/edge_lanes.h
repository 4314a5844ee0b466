// Pairs of edges abreast: which can come to face each other, and how far apart they are. What
// touches is left to faceEdges; here it is told from the many that do not.  [A7, A8]
#pragma once

#include "core/geometry/contact_features.h"
#include "core/math/lanes.h"

namespace scree {

/// Four edges, in the frame of the second shape.
struct EdgeLanes {
    Lanes3 start, direction, outward;
    Lanes length = kNoLanes;  ///< [m]

    void set(int lane, const ConvexEdge& edge)
    {
        start.set(lane, edge.start);
        direction.set(lane, edge.direction);
        outward.set(lane, edge.outward);
        length[lane] = edge.length;
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
EdgeGaps edgeGaps(const EdgeLanes& ofFirst, const EdgeLanes& ofSecond, double deepest,
                  double reach);

}  // namespace scree
