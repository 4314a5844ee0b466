#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "core/collision/contact_list.h"
#include "tests/support/draw.h"

namespace scree::test {
namespace {

/// Appends it or makes one that says the same deeper, looking at each.
void addPlainly(const GapContact& contact, double samePlace, double sameWay,
                std::vector<GapContact>& contacts)
{
    for (GapContact& known : contacts) {
        if ((known.rA - contact.rA).norm() > samePlace) continue;
        if (known.normal.dot(contact.normal) < sameWay) continue;
        if (contact.gap < known.gap) {
            const std::uint64_t feature = known.feature;
            known = contact;
            known.feature = feature;
        }
        return;
    }
    contacts.push_back(contact);
}

// As many as a nut has on its bolt, so close that most say what another has said; those that are
// made deeper move, and others are near them then.
TEST(ContactList, ManyContactsThatSayTheSameAreSaidOnce)
{
    constexpr double kSmaller = 1.0, kSame = 5e-3;
    std::vector<GapContact> told, plainly;
    ContactList list(told, kSmaller, kSmaller, 1.0, 0.0);
    for (std::uint64_t i = 0; i < 3000; ++i) {
        const Vec3 place = 0.03 * signedUnits(1, 3 * i);
        const Vec3 normal = (Vec3::UnitY() + 0.1 * signedUnits(2, 3 * i)).normalized();
        const GapContact contact{i, place, normal, signedUnit(3, i)};
        list.add(contact);
        addPlainly(contact, kSame * kSmaller, 1.0 - kSame, plainly);
    }
    ASSERT_EQ(told.size(), plainly.size());
    EXPECT_GT(told.size(), 200u);
    EXPECT_LT(told.size(), 2500u);
    for (std::size_t i = 0; i < told.size(); ++i) {
        EXPECT_EQ(told[i].feature, plainly[i].feature);
        EXPECT_EQ(told[i].gap, plainly[i].gap);
        EXPECT_EQ(told[i].rA, plainly[i].rA);
    }
}

}  // namespace
}  // namespace scree::test
