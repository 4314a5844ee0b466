// No length, time or speed is built in: a world that is so many times as large, or twice as slow,
// moves as the one it was made from. Where the factor is a power of two that holds to the last bit.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "core/dynamics/stepper.h"
#include "core/geometry/primitives.h"
#include "tests/support/draw.h"
#include "tests/support/scenes.h"

namespace scree::test {
namespace {

/// How many units of the scene one of it is.
struct Scale {
    double length = 1.0, time = 1.0;

    double speed() const { return length / time; }
};

std::shared_ptr<const Shape> scaled(TriMesh mesh, const Scale& scale)
{
    mesh.points *= scale.length;
    return buildMeshShape("solid", mesh);
}

StepSettings settingsAt(const Scale& scale, Method method)
{
    StepSettings settings = method == Method::scree ? screeSettings() : experimentSettings();
    settings.gravity = scale.speed() / scale.time * Vec3(0.0, -9.81, 0.0);
    return settings;
}

World worldAt(const Scale& scale, MaterialId& material)
{
    World world;
    const double arm = 0.005 * scale.length;  // of what resists rolling and spinning
    material = world.addMaterial({"felt", 1000.0, 0.5, 0.3, {arm, arm, 0.0, 0.0}});
    addPlane(world, material);
    return world;
}

/// Sharp, round and nonconvex things that tumble onto each other.
World tumbleAt(const Scale& scale)
{
    MaterialId material = 0;
    World world = worldAt(scale, material);
    const std::vector<std::shared_ptr<const Shape>> shapes = {
        scaled(makeTorus(0.4, 0.1, {16, 10}), scale), scaled(starShape()->mesh, scale),
        scaled(makeSphere(0.25, 3), scale), scaled(makeBox({0.5, 0.3, 0.4}, {1, 1, 1}), scale)};
    for (std::uint64_t i = 0; i < 16; ++i) {
        const Vec3 place(0.1 * signedUnit(41, i), 0.6 + 0.6 * static_cast<double>(i),
                         0.1 * signedUnit(42, i));
        addBody(world, shapes[i % shapes.size()], material,
                {scale.length * place, exponentialMap(signedUnits(43, 3 * i))}, 1.0,
                scale.speed() * Vec3(0.0, -2.0, 0.0), (1.0 / scale.time) * signedUnits(44, 3 * i));
    }
    return world;
}

/// A column of cubes in which a keyed plate comes down until nothing can give way.
World pressAt(const Scale& scale)
{
    MaterialId material = 0;
    World world = worldAt(scale, material);
    const auto key = [&](double seconds, double height) {
        return MotionKey{scale.time * seconds,
                         {{0.0, scale.length * height, 0.0}, Quat::Identity()}};
    };
    addKeyedBody(world, scaled(makeBox({2.0, 0.2, 2.0}, {2, 2, 2}), scale), material,
                 {key(0.0, 1.15), key(0.5, 1.05), key(1.0, 1.1)}, KeyInterpolation::linear);
    const auto cube = scaled(makeBox(0.5 * Vec3::Ones(), {1, 1, 1}), scale);
    for (const double y : {0.25, 0.75}) {
        addBody(world, cube, material,
                {scale.length * Vec3(0.0, y, 0.0), exponentialMap({0.0, 0.3 * y, 0.0})});
    }
    return world;
}

using MakeWorld = World (*)(const Scale&);

constexpr int kFrames = 24;

/// Of the frames of a scene those after which all is where it is in the scene of other units.
int framesAlike(MakeWorld makeWorld, const Scale& scale, Method method)
{
    World world = makeWorld({}), other = makeWorld(scale);
    Stepper stepper(settingsAt({}, method)), stepperOfOther(settingsAt(scale, method));
    for (int k = 0; k < kFrames; ++k) {
        stepper.advanceFrame(world, 1.0 / 24.0);
        stepperOfOther.advanceFrame(other, scale.time / 24.0);
        for (std::size_t b = 0; b < world.bodyCount(); ++b) {
            if (other.motion[b].position != scale.length * world.motion[b].position) return k;
        }
    }
    return kFrames;
}

constexpr double kThousand = 1024.0;

TEST(Scale, WhatTumblesFallsAsInASceneAThousandTimesAsLargeOrAsSmallOrFourTimesAsSlow)
{
    for (const Method method : {Method::scree, Method::paper}) {
        for (const Scale& scale :
             {Scale{kThousand, 1.0}, Scale{1.0 / kThousand, 1.0}, Scale{1.0, 4.0}}) {
            EXPECT_EQ(framesAlike(tumbleAt, scale, method), kFrames)
                << (method == Method::scree ? "scree " : "paper ") << ' ' << scale.length << ' '
                << scale.time;
        }
    }
}

TEST(Scale, WhatIsPressedIsHeldAsInASceneAThousandTimesAsLarge)
{
    EXPECT_EQ(framesAlike(pressAt, {kThousand, 1.0}, Method::scree), kFrames);
}

}  // namespace
}  // namespace scree::test
