// Narrow phase: samples of one body inside the distance field of the other, in both directions.
// [GBF03 “Interference Detection”], [A7, A8, A12, A13]
//
// The method asks for the same pair again and again while an impulse moves it by micrometres, and
// then wants the deepest sample that approaches, seldom all. A Proximity remembers a lower bound of
// the distance of every sample that can matter: the bound falls by as much as the pair moves. Told
// deepest first, samples are looked at only while their bounds are below the deepest one known, and
// the answer is the same as with all of them (a test compares the two).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/collision/placed_pair.h"
#include "core/collision/relative_pose.h"
#include "core/geometry/known_field.h"
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

/// One direction of a pair: the samples of one body in the field of the other.
struct OneWay {
    const Shape* sampled = nullptr;
    const Shape* field = nullptr;
    FieldFromSamples pose;
    bool sampleOnA = true;
};

/// Contour value of a pair: below it a sample interferes. One millionth of the smaller box
/// diagonal, the same in collision and contact.  [A7]
double contourValue(const Shape& a, const Shape& b);

class Proximity {
public:
    /// How far the pair may move, once it has looked, before it looks again [m].
    void setMargin(double margin) { nextMargin_ = margin; }
    /// To be called before another pair is placed.
    void forget() { isKnown_ = false; }

    /// Places the pair: the following calls of next() tell its interferences.
    void place(const PlacedPair& pair, double tau);

    /// The deepest interference that has not been told yet; none when all have.
    std::optional<Touch> next();

    /// Whether there is any with the pair placed so.
    bool interferes(const PlacedPair& pair, double tau);

    /// Appends all interferences of the pair to `touches`, deepest first.
    void findTouches(const PlacedPair& pair, double tau, std::vector<Touch>& touches);

private:
    /// A vertex or an edge of either body.
    struct Candidate {
        double key;          // its distance is at least this less way_ [m]
        double silentUntil;  // the way up to which an edge has no sample [m]
        double boundAt;      // the way at which the bound of an edge was found [m]
        std::int32_t index;
        std::int32_t known;    // of known_, once it has been looked at; or negative
        std::uint32_t seenIn;  // the placing in which it was last looked at
        bool isEdge, isOfA;
    };

    void lookAt(const OneWay& way, double clearance);
    void evaluate(Candidate& candidate);
    KnownField fieldAround(const OneWay& way, Candidate& candidate);
    void evaluateEdge(const OneWay& way, Candidate& candidate);
    void add(const Touch& touch);

    double nextMargin_ = 0.0;
    double margin_ = 0.0;  // of the last look
    bool isKnown_ = false;
    FieldFromSamples lookedAt_;  // the smaller body, when the candidates were chosen

    std::array<OneWay, 2> ways_;  // as placed
    /// How long a path any point has come since the candidates were chosen, at most [m].
    double way_ = 0.0;
    double tau_ = 0.0;
    std::uint32_t placing_ = 0;  // counts since the candidates were chosen
    std::vector<Candidate> candidates_;
    std::vector<KnownFaces> known_;  // around candidates
    double lowestKey_ = 0.0;         // of the candidates; or below
    std::vector<Touch> found_;       // a heap by depth: not told yet
};

/// The deepest interference of a pair that is asked about once, for which a Proximity would gather
/// more than it uses; none when there is none.
std::optional<Touch> deepestTouch(const PlacedPair& pair, double tau);

/// The interferences of a pair found without any memory: the plain reading of the method.
void findTouchesPlainly(const PlacedPair& pair, double tau, std::vector<Touch>& touches);

}  // namespace scree
