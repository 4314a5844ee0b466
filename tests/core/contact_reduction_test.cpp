// Of many places with one normal those are kept that say all others: what may close first when a
// body moves on in any way, and the same ones while it lies still.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "core/base/random.h"
#include "core/collision/contact_reduction.h"
#include "core/collision/near_features.h"
#include "core/geometry/primitives.h"
#include "core/math/rotation.h"
#include "tests/support/draw.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

std::vector<GapContact> contactsAt(const std::vector<Vec3>& places, const std::vector<double>& gaps)
{
    std::vector<GapContact> contacts;
    for (std::size_t i = 0; i < places.size(); ++i)
        contacts.push_back({i, places[i], Vec3::UnitY(), gaps[i]});
    return contacts;
}

std::vector<Vec3> circle(int count, double radius)
{
    std::vector<Vec3> places;
    for (int i = 0; i < count; ++i) {
        const double angle = 2.0 * kPi * i / count;
        places.emplace_back(radius * std::cos(angle), 0.0, radius * std::sin(angle));
    }
    return places;
}

/// The least gap after a tilt of `slope` about the normal's side `d`.
double leastGap(const std::vector<GapContact>& contacts, const Vec3& d, double slope)
{
    double least = std::numeric_limits<double>::infinity();
    for (const GapContact& c : contacts) least = std::min(least, c.gap + slope * d.dot(c.rA));
    return least;
}

TEST(ContactReduction, WhateverTiltsTheKeptOnesCloseAboutAsSoonAsAll)
{
    for (std::uint64_t run = 0; run < 50; ++run) {
        std::vector<Vec3> places;
        std::vector<double> gaps;
        for (std::uint64_t i = 0; i < 60; ++i) {
            places.emplace_back(2.0 * randomUnit(1, run, 3 * i) - 1.0, 0.0,
                                2.0 * randomUnit(1, run, 3 * i + 1) - 1.0);
            gaps.push_back(run % 2 == 0 ? 0.0 : 0.01 * randomUnit(1, run, 3 * i + 2));
        }
        const std::vector<GapContact> all = contactsAt(places, gaps);
        std::vector<GapContact> kept = all;
        reduceContacts(kept, 0, Mat3::Identity(), 1.0);
        EXPECT_LE(kept.size(), 25u);
        EXPECT_EQ(leastGap(kept, Vec3::UnitX(), 0.0), leastGap(all, Vec3::UnitX(), 0.0));
        for (int k = 0; k < 32; ++k) {
            const Vec3 d(std::cos(0.2 * k), 0.0, std::sin(0.2 * k));
            for (const double slope : {0.003, 0.1}) {
                // An eighth of a turn between directions may miss a corner of the hull.
                const double missed = leastGap(kept, d, slope) - leastGap(all, d, slope);
                EXPECT_LE(missed, 0.25 * slope + 1e-3) << run << ' ' << k;
            }
        }
    }
}

TEST(ContactReduction, WhatStandsOnABossStandsOnAllOfIt)
{
    std::vector<Vec3> places = circle(12, 1.0), boss = circle(12, 0.1);
    places.insert(places.end(), boss.begin(), boss.end());
    std::vector<double> gaps(12, 0.005);
    gaps.resize(24, 0.0);
    std::vector<GapContact> contacts = contactsAt(places, gaps);
    reduceContacts(contacts, 0, Mat3::Identity(), 1.0);
    const auto onBoss = std::count_if(contacts.begin(), contacts.end(),
                                      [](const GapContact& c) { return c.gap == 0.0; });
    EXPECT_GE(onBoss, 8);
    EXPECT_GE(std::ssize(contacts) - onBoss, 6);
}

// A spoon that lay on the floor by a bent underside was told of the deeper of its rows at one end
// only, pushed up there, and told of the other end.
TEST(ContactReduction, ARowThatLiesDeeperThanThoseBesideItKeepsBothEnds)
{
    std::vector<Vec3> places;
    std::vector<double> gaps;
    for (int row = -1; row <= 1; ++row) {
        for (int i = 0; i <= 8; ++i) {
            places.emplace_back(-0.4 + 0.1 * i, 0.0, 0.05 * row);
            gaps.push_back(row == 0 ? -2e-4 - 1e-6 * i : 0.0);
        }
    }
    std::vector<GapContact> contacts = contactsAt(places, gaps);
    reduceContacts(contacts, 0, Mat3::Identity(), 1.0);
    for (const double end : {-0.4, 0.4}) {
        EXPECT_TRUE(std::ranges::any_of(contacts, [&](const GapContact& c) {
            return c.gap < 0.0 && std::abs(c.rA.x() - end) < 1e-9;
        })) << end;
    }
}

TEST(ContactReduction, FewContactsAndThoseOfOtherNormalsStay)
{
    std::vector<GapContact> contacts = contactsAt(circle(8, 1.0), std::vector<double>(8, 0.0));
    reduceContacts(contacts, 0, Mat3::Identity(), 1.0);
    EXPECT_EQ(contacts.size(), 8u);
    contacts = contactsAt(circle(40, 1.0), std::vector<double>(40, 0.0));
    for (std::size_t i = 0; i < 40; i += 5) contacts[i].normal = {0.6, 0.8, 0.0};
    reduceContacts(contacts, 0, Mat3::Identity(), 1.0);
    const auto slanted = std::count_if(contacts.begin(), contacts.end(),
                                       [](const GapContact& c) { return c.normal.x() > 0.0; });
    EXPECT_EQ(slanted, 8);
    EXPECT_LE(std::ssize(contacts) - slanted, 9);
}

// As of a bowl in a bowl: no two of these normals are one.
TEST(ContactReduction, OfManyPlacesAllAroundThoseStayThatHoldTheRest)
{
    std::vector<GapContact> all;
    for (int row = 0; row < 5; ++row) {
        for (int i = 0; i < 60; ++i) {
            const double angle = 2.0 * kPi * i / 60, r = 0.6 + 0.1 * row;
            const Vec3 out(std::cos(angle), 0.0, std::sin(angle));
            all.push_back({all.size(), r * (out + Vec3::UnitY()),
                           (Vec3::UnitY() - out).normalized(), 1e-3 * randomUnit(2, row, i)});
        }
    }
    std::vector<GapContact> kept = all;
    reduceContacts(kept, 0, Mat3::Identity(), 1.0);
    EXPECT_LE(kept.size(), 150u);
    for (std::uint64_t run = 0; run < 200; ++run) {
        const double by = run % 2 == 0 ? 0.003 : 0.03;
        const Vec3 way = by * signedUnits(run, 0), turn = by * signedUnits(run, 3);
        const auto leastAfter = [&](const std::vector<GapContact>& contacts) {
            double least = std::numeric_limits<double>::infinity();
            for (const GapContact& c : contacts)
                least = std::min(least, c.gap + c.normal.dot(way + turn.cross(c.rA)));
            return least;
        };
        EXPECT_LE(leastAfter(kept) - leastAfter(all), 0.05 * by) << run;
    }
}

TEST(ContactReduction, AFineDiscThatTremblesKeepsItsPlaces)
{
    std::set<std::uint64_t> known;
    for (std::uint64_t run = 0; run < 20; ++run) {
        std::vector<double> gaps(64);
        for (std::uint64_t i = 0; i < 64; ++i) gaps[i] = 1e-4 * randomUnit(5, run, i);
        std::vector<GapContact> contacts = contactsAt(circle(64, 1.0), gaps);
        const auto lowest = std::min_element(gaps.begin(), gaps.end()) - gaps.begin();
        reduceContacts(contacts, 0, Mat3::Identity(), 1.0);
        std::set<std::uint64_t> kept;
        for (const GapContact& c : contacts) kept.insert(c.feature);
        EXPECT_TRUE(kept.contains(static_cast<std::uint64_t>(lowest)));
        if (run == 0) known = kept;
        const auto others = std::count_if(kept.begin(), kept.end(), [&](std::uint64_t feature) {
            return !known.contains(feature);
        });
        EXPECT_LE(others, 1) << run;
    }
}

TEST(ContactReduction, ARingOnTheFloorKeepsItsPlacesWhereverItLiesAndHoweverItTrembles)
{
    const auto ring = buildMeshShape("ring", makeTorus(1.0, 0.25, {16, 10}));
    const auto floor = buildPlaneShape("floor");
    std::set<std::uint64_t> known;
    for (std::uint64_t i = 0; i < 40; ++i) {
        const auto tremble = [&](std::uint64_t k) {
            return 4e-4 * (randomUnit(3, i, k) - 0.5);  // a slop of 1e-4 of it
        };
        const Quat tilt = exponentialMap(Vec3(tremble(0), 0.0, tremble(1)));
        const Quat turn = exponentialMap(Vec3(0.0, 0.37 * static_cast<double>(i), 0.0));
        const Pose at{{0.0, 0.2378 + tremble(2), 0.0}, tilt * turn};
        std::vector<GapContact> contacts;
        NearFeatures().findContacts({ring.get(), floor.get(), at, Pose{}}, 0.01, contacts);
        ASSERT_GE(contacts.size(), 8u);
        ASSERT_LE(contacts.size(), 9u);
        if (i == 0) {
            for (const GapContact& c : contacts) known.insert(c.feature);
        }
        std::size_t others = 0;
        for (const GapContact& c : contacts) others += !known.contains(c.feature);
        EXPECT_LE(others, 1u) << i;  // the lowest, when it is none of the eight
    }
}

}  // namespace
}  // namespace scree::test
