#include "core/collision/contact_list.h"

#include <algorithm>
#include <utility>

namespace scree {
namespace {

/// Where so many touch, as a nut and its bolt do, only those that are near by are looked at. A
/// fine thread has seven thousand for each pair.
constexpr std::size_t kMany = 32;

/// Contacts nearer to each other than this share of the smaller body, with normals as close,
/// are one; but not those on either side of what is thin: a rod five hundred times as long as it is
/// thick was told of one side, and rocked on it for ever. Some are always one, as at a tip.
constexpr double kSamePlace = 5e-3, kOfThickness = 0.2, kLeastPlace = 5e-4;
/// Cosine of the angle within which a contact may speak for another that is not as near.
constexpr double kSameWay = 0.5;
/// And how round surfaces are at least: their radius, over that of the smaller body. Logs that lie
/// along each other touch at both ends. Told of the nearer end alone, three in a stack fell 8 mm
/// into each other.
constexpr double kFlattest = 20.0;

}  // namespace

ContactList::ContactList(std::vector<GapContact>& contacts, double smaller, double thickness,
                         double reach, double bulge)
    : contacts_(contacts),
      first_(contacts.size()),
      smaller_(smaller),
      samePlace_(std::clamp(kOfThickness * thickness, kLeastPlace * smaller, kSamePlace * smaller)),
      sharpness_(sharpnessOf(smaller, thickness)),
      reach_(reach),
      bulge_(bulge)
{
}

bool ContactList::add(const RelativePair& way, ContactPart ofFirst, ContactPart ofSecond,
                      const ToWorld& toWorld, std::uint64_t feature, const FeatureContact& found)
{
    if (bulge_ == 0.0) {
        add(toWorld(feature, found));
        return true;
    }
    const Rounding rounding = roundContact(way, ofFirst, ofSecond, found);
    if (rounding.result == Rounding::Result::none) {
        if (found.gap < reach_) add(toWorld(feature, found));
    } else if (rounding.result == Rounding::Result::elsewhere) {
        if (found.gap < reach_) elsewhere_.push_back(toWorld(feature, found));
    } else if (rounding.contact.gap < reach_) {
        const auto [a, b] = toWorld.firstIsA ? std::pair(rounding.first, rounding.second)
                                             : std::pair(rounding.second, rounding.first);
        add(toWorld(featureId(FeatureKind::round, a, b), rounding.contact));
    }
    return rounding.result != Rounding::Result::elsewhere;
}

void ContactList::add(const GapContact& contact)
{
    const std::size_t i = knownAs(contact);
    if (i == contacts_.size()) {
        contacts_.push_back(contact);
        return;
    }
    GapContact& known = contacts_[i];
    if (contact.gap >= known.gap) return;
    known.gap = contact.gap;
    known.rA = contact.rA;
    known.normal = contact.normal;
    if (grid_ && i - first_ < grid_->size()) grid_->move(i - first_, known.rA);
}

double ContactList::heardBelow() const
{
    double deepest = 0.0;
    for (std::size_t i = first_; i < contacts_.size(); ++i)
        deepest = std::min(deepest, contacts_[i].gap);
    const double notSpokenFor = deepest - sharpness_;
    return unsupported_ ? std::min(notSpokenFor, unsupported_->gap) : notSpokenFor;
}

/// In a deep overlap the geometry of touching means little. A corner inside is still a corner
/// inside: without any contact about as deep, the deepest one speaks. A ring that had slid over
/// the rim of another, a corner first, sank 26 mm into it: its faces sloped too much to stand
/// there, its edges ended in that corner and crossed nothing, and a fifth of a millimetre at
/// the far side of the ring was taken for all there was. An edge that pokes through the sharp
/// edge of a prism by its last millimetre sank as deep: its corner was out on the other side.
/// So does an edge inside that tells no way out: prisms locked 14 % of their size deep while
/// nothing was told, as nothing of a tip that had come out behind an edge showed that it did
/// not leave by a face.
void ContactList::finish()
{
    // A round part that touches elsewhere has nothing to say, if that place is known.
    for (const GapContact& contact : elsewhere_) {
        const bool isSpokenFor =
            std::any_of(contacts_.begin() + static_cast<std::ptrdiff_t>(first_), contacts_.end(),
                        [&](const GapContact& c) { return speaksFor(c, contact); });
        if (!isSpokenFor) contacts_.push_back(contact);
    }
    if (!unsupported_) return;
    const double about = std::min(unsupported_->gap + sharpness_, 0.0);
    const bool isSpokenFor =
        std::any_of(contacts_.begin() + static_cast<std::ptrdiff_t>(first_), contacts_.end(),
                    [&](const GapContact& c) { return c.gap < about; });
    if (!isSpokenFor) contacts_.push_back(*unsupported_);
}

bool ContactList::speaksFor(const GapContact& known, const GapContact& contact) const
{
    const double square = (known.rA - contact.rA).squaredNorm();
    const double parted = contact.gap - known.gap;
    return parted >= 0.0 && known.normal.dot(contact.normal) > kSameWay &&
           square <= 2.0 * kFlattest * smaller_ * (parted + bulge_);
}

std::size_t ContactList::knownAs(const GapContact& contact)
{
    const auto isSame = [&](const GapContact& known) {
        return (known.rA - contact.rA).squaredNorm() <= samePlace_ * samePlace_ &&
               known.normal.dot(contact.normal) >= 1.0 - kSamePlace;
    };
    const std::size_t end = contacts_.size();
    if (end - first_ < kMany) {
        std::size_t i = first_;
        while (i < end && !isSame(contacts_[i])) ++i;
        return i;
    }
    if (!grid_) grid_.emplace(samePlace_);
    while (grid_->size() < end - first_) grid_->add(contacts_[first_ + grid_->size()].rA);
    std::size_t known = end;
    grid_->visitNear(contact.rA, [&](std::size_t i) {
        if (first_ + i < known && isSame(contacts_[first_ + i])) known = first_ + i;
    });
    return known;
}

}  // namespace scree
