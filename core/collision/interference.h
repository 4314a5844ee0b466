// Narrow phase: samples of one body inside the distance field of the other, in both directions.
// [GBF03 “Interference Detection”], [A7, A8, A12, A13]
//
// The method asks for the same pair again and again while an impulse moves it by micrometres. A
// Proximity remembers which samples can matter at all: those not provably clear of the other body
// by a margin. As long as the pair has moved less than the margin since, only these are tested, and
// the answer is the same as with all of them (a test compares the two).
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/shape.h"

namespace scree {

/// A sample of one body at less than tau from the other: an interference.
struct Touch {
    double phi = 0.0;         ///< signed distance to the other body [m]
    std::int32_t sample = 0;  ///< stable id in its body (surface_samples.h)
    bool sampleOnA = true;    ///< whose sample it is
    Vec3 point;               ///< object frame of the body that owns the sample [m]
};

/// Deepest first; equal depths by side and id, so that the order is total.
inline bool isDeeper(const Touch& p, const Touch& q)
{
    if (p.phi != q.phi) return p.phi < q.phi;
    if (p.sampleOnA != q.sampleOnA) return p.sampleOnA;
    return p.sample < q.sample;
}

/// Two bodies, placed. Pointers only borrow.
struct PlacedPair {
    const Shape* shapeA;
    const Shape* shapeB;
    Pose worldFromA, worldFromB;
};

/// Contour value of a pair: below it a sample interferes. One millionth of the smaller box
/// diagonal, the same in collision and contact.  [A7]
double contourValue(const Shape& a, const Shape& b);

class Proximity {
public:
    /// Forgets everything; `margin` is how far the pair may move before it looks again [m].
    void reset(double margin);

    /// Appends all interferences of the pair to `touches`, unsorted but in a fixed order.
    void findTouches(const PlacedPair& pair, double tau, std::vector<Touch>& touches);

    /// Whether there is any.
    bool interferes(const PlacedPair& pair, double tau);

private:
    struct NearSample {
        double atLeast;      // lower bound of its distance when looked at [m]
        std::int32_t index;  // of the vertex or edge
    };
    struct NearSamples {
        std::vector<NearSample> vertices, edges;  // closest first
    };

    /// Makes the lists good for the pair as it is placed; answers how far it has moved since they
    /// were made.
    double lookAgainIfMoved(const PlacedPair& pair, double tau);
    bool isEmpty() const;

    double margin_ = 0.0;
    bool isKnown_ = false;
    Mat3 rotation_ = Mat3::Identity();  // B from A when looked at
    Vec3 translation_ = Vec3::Zero();
    NearSamples ofA_, ofB_;
};

/// The interferences of a pair found without any memory: the plain reading of the method.
void findTouchesPlainly(const PlacedPair& pair, double tau, std::vector<Touch>& touches);

}  // namespace scree
