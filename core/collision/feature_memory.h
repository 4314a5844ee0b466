// Which features of two bodies may come within reach of each other, and for how long the others are
// far: the search of near_features.h, which makes contacts of what is found here.
//
// Of all features of two bodies few matter, and in the next step mostly the same. They are found by
// trees of spheres over the features of each, looked up in the distance field of the other, and
// remembered: distances change no faster than points move. So for every feature there is a place on
// the way of the pair (how far any point has moved in the frame of the other body, added up) before
// which it need not be looked at; and for most pairs one for all of them.
//
// What was asked before changes only what is asked again. Contacts are none of its business: it is
// told distances of corners by whoever asks for these, and measures edges by itself.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/collision/contact_with_gap.h"
#include "core/collision/relative_pair.h"
#include "core/geometry/distance_lanes.h"
#include "core/math/lanes.h"

namespace scree {

/// Lower bound of the distance between two bodies, seen both ways, from a few spheres around their
/// features [m].
double apartAtLeast(const RelativePair& pair, const RelativePair& back);

/// How far beyond its reach a look sees, so that it serves for a while [m]. `pace`: how far the
/// pair goes from one time it is asked about to the next [m].
double lookAhead(const RelativePair& pair, double reach, double pace);

/// Two edges, as their shapes count them.
struct EdgePair {
    std::int32_t ofA, ofB;
};

/// `pair` is A seen from B and `back` is B seen from A, throughout.
class alignas(64) FeatureMemory {
public:
    /// Follows the pair; answers whether it has to be looked at again.
    bool isStaleAt(const RelativePair& pair, double reach);

    /// Looks at all features, so as to serve while the pair goes no farther than `window` [m];
    /// answers how far apart the bodies are at least [m]. What is nearer than that is noted.
    double look(const RelativePair& pair, const RelativePair& back, double reach, double window);

    /// How far the pair has gone since it was asked about before [m].
    double pace() const { return pace_; }

    /// Calls distanceOf(corner), which answers how far that is at least [m], for the corners of one
    /// body that may be nearer to the other than `reach`.
    template <class DistanceOf>
    void visitCorners(FeatureKind kind, double reach, const DistanceOf& distanceOf)
    {
        const FloatLanes needed = floatLanesOf(roundedUp(reach + moved_));
        for (NearCorners& eight : kind == FeatureKind::cornerOfA ? cornersOfA_ : cornersOfB_) {
            for (unsigned bits = bitsOf(eight.farUntil < needed); bits; bits &= bits - 1) {
                const int lane = std::countr_zero(bits);
                const double atLeast = distanceOf(eight.corner[lane]);
                eight.farUntil[lane] = roundedDown(moved_ + atLeast);
            }
        }
    }

    /// Finds the pairs of edges that may touch; `isNew` right after a look, all of whose pairs are
    /// then measured and those kept that may matter before the next.
    void findEdges(const RelativePair& pair, double reach, bool isNew,
                   std::vector<EdgePair>& mayTouch);

    /// How much longer a way there is, in the world, before there may be others [m].
    double farFor(const RelativePair& pair) const;

    void prefetchLists() const;

private:
    static constexpr float kInfinity = std::numeric_limits<float>::infinity();
    static constexpr FloatLanes kNever = {kInfinity, kInfinity, kInfinity, kInfinity,
                                          kInfinity, kInfinity, kInfinity, kInfinity};

    /// What is told eight at a time, in single precision, on the way since the last look [m]. Lanes
    /// that are left over are infinitely far.
    struct alignas(64) NearCorners {
        FloatLanes farUntil = kNever;  // how far they were when last looked at
        std::array<std::int32_t, kFloatLanes> corner = {};
    };
    struct alignas(64) NearEdges {
        FloatLanes farUntil = kNever;
        FloatLanes outsideUntil = kNever;  // the way until which they cannot have crossed
        std::array<std::int32_t, kFloatLanes> ofA = {}, ofB = {};
    };

    /// In single precision, and then some: what is remembered must not be more than was seen.
    static float roundedDown(double x)
    {
        return static_cast<float>(x - kSinglePrecision * std::abs(x));
    }
    static double roundedUp(double x) { return x + kSinglePrecision * std::abs(x); }

    /// Each answers how far all of its features are at least, if none is near, and otherwise the
    /// clearance [m].
    double lookAtCorners(const RelativePair& pair, std::vector<NearCorners>& near) const;
    double lookAtEdges(const RelativePair& pair, const RelativePair& back, double reach,
                       std::vector<NearEdges>& found) const;
    void measureEdges(const RelativePair& pair, double reach, std::vector<NearEdges>& near,
                      std::vector<EdgePair>& mayTouch) const;
    void keep(const std::vector<NearEdges>& found, double reach);

    /// What the last look of this thread has found, before it is known what of that to keep.
    static std::vector<NearEdges>& foundEdges();

    double moved_ = 0.0;                // the way since the last look [m]
    double pace_ = 0.0;                 // the last part of it [m]
    double window_ = 0.0;               // for which that is good [m]
    double clearance_ = 0.0;            // everything nearer was noted then [m]
    Mat3 rotation_ = Mat3::Identity();  // B from A, when last asked about
    Vec3 place_ = Vec3::Zero();         // of the one whose way it is, seen from the other [m]
    std::vector<NearCorners> cornersOfA_, cornersOfB_;
    std::vector<NearEdges> edges_;
};

}  // namespace scree
