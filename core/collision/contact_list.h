// The contacts of one pair while they are being found: where several features say the same it is
// said once, and what stands for a round surface is moved to it (round_contacts.h).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/collision/contact_with_gap.h"
#include "core/collision/place_grid.h"
#include "core/collision/round_contacts.h"

namespace scree {

/// Turns what one way found into the contact of the pair.
struct ToWorld {
    Mat3 worldFromSecond;
    Vec3 secondFromA;  // centre of the second from that of A, world [m]
    bool firstIsA;

    GapContact operator()(std::uint64_t feature, const FeatureContact& found) const
    {
        const Vec3 normal = worldFromSecond * found.normal;
        const Vec3 onFirst = worldFromSecond * found.point + secondFromA;
        return {feature, onFirst - 0.5 * found.gap * normal, firstIsA ? normal : Vec3(-normal),
                found.gap};
    }
};

/// What a pair touches with so far, and what lies inside without being a contact.
class ContactList {
public:
    /// Appends to `contacts` what is nearer than `reach`. `smaller`: bounding radius of the smaller
    /// body; `thickness`: of the thinner one; `bulge`: how far facets lie below the round surfaces
    /// that they stand for, at most; 0 where no body is round [m].
    ContactList(std::vector<GapContact>& contacts, double smaller, double thickness, double reach,
                double bulge);

    /// What a pair of parts has found, or what they stand for. Answers whether that is where they
    /// touch.
    bool add(const RelativePair& way, ContactPart ofFirst, ContactPart ofSecond,
             const ToWorld& toWorld, std::uint64_t feature, const FeatureContact& found);

    /// Where two corners meet, or an edge ends on another, several features say the same.
    void add(const GapContact& contact);

    void addUnsupported(const GapContact& contact)
    {
        if (!unsupported_ || contact.gap < unsupported_->gap) unsupported_ = contact;
    }

    /// What lies inside by more than the sharpness is heard in the end only if it is deeper than
    /// this [m].
    double heardBelow() const;

    /// Once all has been added: what is not spoken for speaks for itself.
    void finish();

private:
    /// The first that says the same; the count of all if none does.
    std::size_t knownAs(const GapContact& contact);

    /// Whether round surfaces touch where `known` is and part from there to `contact`.
    bool speaksFor(const GapContact& known, const GapContact& contact) const;

    std::vector<GapContact>& contacts_;
    std::size_t first_;
    double smaller_, samePlace_, sharpness_, reach_, bulge_;
    std::optional<GapContact> unsupported_;
    std::optional<PlaceGrid> grid_;      // of contacts, in their order, as far as asked for
    std::vector<GapContact> elsewhere_;  // of round parts that touch at another place, if at all
};

}  // namespace scree
