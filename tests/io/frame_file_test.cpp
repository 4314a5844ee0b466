// Frame files: what is written is what is read, and damage is seen.
#include "io/frame_file.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>
#include <utility>

#include "io/world_state.h"
#include "tests/io/take_fixture.h"
#include "tests/support/refusal.h"

namespace scree {
namespace {

class FrameFile : public test::TakeFixture {};

TEST_F(FrameFile, RestoringAStateGivesBackEveryBit)
{
    World moved = world;
    advance(moved);
    moved.clock.subStep = 7;
    moved.clock.frameTimeDone = 0.1;
    moved.contactMemory.dt = 0.01;
    moved.contactMemory.contacts = {
        {0, 1, 7, Vec3(0.1, 0.2, 0.3), Vec3(1.0, 9.0, 2.0), Vec3(0.0, 0.5, 0.0)}};
    moved.contactMemory.rest.resize(moved.bodyCount());
    moved.contactMemory.rest[1].unbalancedFrames = 3;
    const std::string bytes = encodeFrame(captureState(shot, moved));

    World restored = buildWorld(shot);
    restoreState(restored, decodeFrame(bytes, "memory"));

    EXPECT_EQ(stateHash(restored), stateHash(moved));
    EXPECT_EQ(restored.clock.frameTimeDone, 0.1);
    EXPECT_EQ(encodeFrame(captureState(shot, restored)), bytes);
}

TEST_F(FrameFile, EverySingleFlippedByteOfAFrameIsNoticed)
{
    const std::string bytes = encodeFrame(captureState(shot, world));
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::string damaged = bytes;
        damaged[i] ^= 0x10;
        EXPECT_THROW(decodeFrame(damaged, "memory"), Error) << "byte " << i;
    }
}

TEST_F(FrameFile, EveryCutOfAFrameIsNoticed)
{
    const std::string bytes = encodeFrame(captureState(shot, world));
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_THROW(decodeFrame(bytes.substr(0, size), "memory"), Error) << size << " bytes";
}

TEST_F(FrameFile, AStateThatNoStepCouldGoOnFromIsRefusedThoughItsChecksumFits)
{
    const FrameState good = captureState(shot, world);
    const auto expectRefusal = [&](const std::string& reason, const auto& spoil) {
        FrameState state = good;
        spoil(state);
        const test::Refusal refusal =
            test::refusalBy([&] { decodeFrame(encodeFrame(state), "memory"); });
        EXPECT_TRUE(refusal.mentions(reason)) << refusal.message;
    };
    const auto remember = [](FrameState& state,
                             std::initializer_list<std::pair<BodyId, BodyId>> pairs) {
        state.contactMemory.dt = 0.01;
        for (const auto& [a, b] : pairs)
            state.contactMemory.contacts.push_back(
                {a, b, 0, Vec3::Zero(), Vec3::Zero(), Vec3::Zero()});
    };
    EXPECT_NO_THROW(decodeFrame(encodeFrame(good), "memory"));
    for (const BodyId wrong : {2000000000, -1, good.order[0]})
        expectRefusal("order of bodies", [&](FrameState& s) { s.order[1] = wrong; });
    expectRefusal("clock", [](FrameState& s) { s.clock.subStep = -1; });
    expectRefusal("clock", [](FrameState& s) { s.clock.frameTimeDone = NAN; });
    expectRefusal("clock", [](FrameState& s) { s.clock.frameTimeDone = -0.01; });
    expectRefusal("body 1", [](FrameState& s) { s.motion[1].velocity.y() = INFINITY; });
    expectRefusal("does not exist", [&](FrameState& s) { remember(s, {{0, 2}}); });
    expectRefusal("not in order", [&](FrameState& s) { remember(s, {{1, 1}, {0, 1}}); });
    expectRefusal("not two in order", [&](FrameState& s) { remember(s, {{1, 1}}); });
    expectRefusal("not two in order", [&](FrameState& s) { remember(s, {{1, 0}}); });
    expectRefusal("body 1 is turned by what is no rotation",
                  [](FrameState& s) { s.motion[1].orientation.coeffs() *= 1.00001; });
    for (const double wrong : {-0.01, double{NAN}, double{INFINITY}})
        expectRefusal("took a time", [&](FrameState& s) { s.contactMemory.dt = wrong; });
    for (Vec3 RememberedContact::*member :
         {&RememberedContact::place, &RememberedContact::force, &RememberedContact::couple}) {
        expectRefusal("bodies 0 and 1 carries", [&](FrameState& s) {
            remember(s, {{0, 1}});
            (s.contactMemory.contacts[0].*member).z() = NAN;
        });
    }
    const auto expectNoRest = [&](const auto& spoil) {
        expectRefusal("body 1 remembers a rest", [&](FrameState& s) {
            s.contactMemory.rest.resize(s.motion.size());
            s.contactMemory.rest[0].unbalancedFrames = 1;
            spoil(s.contactMemory.rest[1]);
        });
    };
    expectNoRest([](BodyRest& rest) { rest.pull.x() = INFINITY; });
    expectNoRest([](BodyRest& rest) { rest.unbalancedFrames = -1; });
    for (Stay BodyRest::*stay : {&BodyRest::still, &BodyRest::nearby, &BodyRest::around}) {
        expectNoRest([&](BodyRest& rest) { (rest.*stay).position.y() = NAN; });
        expectNoRest([&](BodyRest& rest) { (rest.*stay).orientation.w() = 0.5; });
        expectNoRest([&](BodyRest& rest) { (rest.*stay).frames = -2; });
    }
    expectRefusal("inside a frame", [](FrameState& s) {
        s.clock.subStep = 1;
        s.contactMemory.rest.resize(s.motion.size());
    });
}

TEST_F(FrameFile, WhatTheLastStepDidIsKeptAndIsNoPartOfTheState)
{
    StepSeen step;
    step.dt = 1.0 / 96.0;
    step.level = {0, 1};
    step.overlap = {1e-5, 1e-5};
    step.contacts = {{0, 1, {0.1, 0.2, 0.3}, {0.0, -1.0, 0.0}, {0.5, -4.0, 0.25}},
                     {0, 1, {0.4, 0.2, 0.3}, {0.0, -1.0, 0.0}, {0.0, -3.0, 0.0}}};
    FrameState state = captureState(shot, world);
    const std::string without = encodeFrame(state);
    state.lastStep = step;
    const FrameState back = decodeFrame(encodeFrame(state), "memory");
    ASSERT_TRUE(back.lastStep);
    EXPECT_EQ(back.lastStep->dt, step.dt);
    EXPECT_EQ(back.lastStep->level, step.level);
    EXPECT_EQ(back.lastStep->overlap, step.overlap);
    ASSERT_EQ(back.lastStep->contacts.size(), 2U);
    EXPECT_EQ(back.lastStep->contacts[1].point, step.contacts[1].point);
    EXPECT_EQ(back.lastStep->contacts[0].normal, step.contacts[0].normal);
    EXPECT_EQ(back.lastStep->contacts[0].impulse, step.contacts[0].impulse);

    World restored = buildWorld(shot);
    restoreState(restored, back);
    EXPECT_EQ(encodeFrame(captureState(shot, restored)), without);
    state.lastStep->contacts[0].b = 2;  // there are two bodies
    EXPECT_THROW(decodeFrame(encodeFrame(state), "memory"), Error);
}

}  // namespace
}  // namespace scree
