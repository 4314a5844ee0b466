// A field asked again and again near the same places: what was found there answers for them.  [A4]
//
// Impulses move a pair by micrometres, so a sample meets the face that it met before. As long as it
// is sure to, only that face is asked (SignedDistance::placeAround), and the answer is the field's
// own, to the bit: 16 ns instead of 77 on the ring (tests/benchmarks/distance_benchmark.cpp). In a
// heap of a thousand rings by method paper all but three in a thousand questions near the surface
// are answered so, and a frame takes a quarter less time; with five hundred bones a sixteenth.
#pragma once

#include <array>

#include "core/geometry/signed_distance.h"

namespace scree {

/// The places last found along an edge, or around a vertex, of another body: as many as an edge is
/// asked at. With half as many, edges forget what they come back to.
class KnownFaces {
public:
    /// Null: none.
    const FacePlace* holding(const Vec3& point) const
    {
        for (const FacePlace& place : places_) {
            if (place.holds(point)) return &place;
        }
        return nullptr;
    }
    /// In place of the oldest.
    void add(const FacePlace& place)
    {
        if (place.faceCount == 0) return;
        places_[next_] = place;
        next_ = (next_ + 1) % places_.size();
    }

private:
    std::array<FacePlace, 8> places_;
    std::uint32_t next_ = 0;
};

class KnownField {
public:
    /// Borrows both. `known` is of this field alone; null: nothing is remembered.
    KnownField(const SignedDistance& field, KnownFaces* known = nullptr)
        : field_(field), known_(known)
    {
    }

    double spacing() const { return field_.spacing(); }

    double value(const Vec3& point) const
    {
        if (!known_) return field_.value(point);
        if (const FacePlace* place = known_->holding(point)) return field_.value(point, *place);
        const double grid = field_.gridValue(point);
        if (!field_.isRefined(grid)) return grid;
        known_->add(field_.placeAround(point, grid));
        return field_.exact(point);
    }

    SignedDistance::Sloped sloped(const Vec3& point) const
    {
        if (!known_) return field_.sloped(point);
        if (const FacePlace* place = known_->holding(point)) return field_.sloped(point, *place);
        const double grid = field_.gridValue(point);
        if (field_.isRefined(grid)) known_->add(field_.placeAround(point, grid));
        return field_.sloped(point);
    }

private:
    const SignedDistance& field_;
    KnownFaces* known_;
};

}  // namespace scree
