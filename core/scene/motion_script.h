// Keyed motion: the pose of a body as a function of time, through keys an artist sets.  [A54]
//
// Every stretch between two keys is a cubic Bézier curve, for positions and orientations alike, in
// its cumulative form [KKS95]: start, then three steps d1, d2, d3 of which growing shares are
// taken. Velocities are then bounded by the steps alone, which is what the limit of the time step
// asks for.
//
// Symbols: t time, s share of it that has passed, d step of a position
//          [m], w of an orientation (rotation vector, axes of the body) [rad].
#pragma once

#include <array>
#include <vector>

#include "core/math/types.h"

namespace scree {

struct MotionKey {
    double time = 0.0;  ///< [s]
    Pose pose;          ///< world from asset
};

enum class KeyInterpolation {
    smooth,  ///< passes keys without a kink, rests at the first and the last, never overshoots
    linear,  ///< steady from key to key; the velocity jumps at keys
};

/// Bounds on what a script does in some span of time.
struct ScriptBounds {
    std::vector<Vec3> velocities;  ///< the velocity of the asset's origin lies in their hull [m/s]
    double spin = 0.0;             ///< the largest angular speed [rad/s]
};

class MotionScript {
public:
    /// `keys` in order of time, no two at the same, at least one. Turns take the shorter way from
    /// key to key. Before the first key and after the last the pose is held.
    MotionScript(const std::vector<MotionKey>& keys, KeyInterpolation interpolation);

    /// Where the asset is at time t.
    Pose at(double t) const;

    ScriptBounds boundsBetween(double from, double to) const;

    /// Nothing moves after it [s].
    double lastKeyTime() const { return last_.time; }

private:
    struct Stretch {
        double start = 0.0, duration = 1.0;
        Pose first;
        std::array<Vec3, 3> d, w;
    };

    std::vector<Stretch> stretches_;
    MotionKey first_, last_;
};

}  // namespace scree
