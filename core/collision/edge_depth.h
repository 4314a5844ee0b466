// The samples of an edge: where along it the field of another body is deepest.  [A8]
#pragma once

#include <cstdint>
#include <vector>

#include "core/collision/relative_pose.h"
#include "core/geometry/known_field.h"
#include "core/geometry/surface_samples.h"

namespace scree {

/// An edge seen from the field: fixed lattice points, so that skipping some never changes the rest.
struct EdgeInField {
    Vec3 start, alongStep;  ///< one lattice step [m]
    int steps;              ///< lattice points 0 … steps, the ends are vertices
    double stepLength;      ///< [m]

    Vec3 at(double t) const { return start + t * alongStep; }
    double length() const { return stepLength * steps; }
};

/// `pose`: of the samples, seen from the field.
EdgeInField placeEdge(const SurfaceSamples& samples, std::int32_t edge,
                      const FieldFromSamples& pose, const KnownField& field);

/// A sample of an edge: where, in lattice steps, and its distance [m].
struct EdgeDepth {
    double t, phi;
};

/// Below this an edge speaks for itself: tau, and clearly deeper than its nearer end.
double edgeLimit(const KnownField& field, double phiStart, double phiEnd, double tau);

/// Appends the samples of an edge below `limit`: its deepest point, or, where the depth is flat,
/// the middle and the ends of the flat part.
void sampleEdge(const KnownField& field, const EdgeInField& edge, double phiStart, double limit,
                std::vector<EdgeDepth>& found);

/// A lower bound of the field along the edge, exact to h/8 or at least half of it or above
/// `enough`: where two points at distance s have values p and q, nothing between them is below
/// (p + q − s)/2.
double lowerBoundAlong(const KnownField& field, const EdgeInField& edge, double enough);

}  // namespace scree
