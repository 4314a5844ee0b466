#include "render/rasterizer.h"

#include <cstdlib>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "core/geometry/primitives.h"
#include "tests/support/png_file.h"
#include "tests/support/support.h"

namespace scree {
namespace {

constexpr int kWidth = 320, kHeight = 180;

/// A scene that grows body by body; the looks and the one frame grow with it.
struct Stage {
    SceneDescription scene;
    std::vector<Look> looks;
    SceneFrame frame;

    void add(const SceneMesh& mesh, const Pose& pose, const Look& look, bool moves = true)
    {
        const std::string name = "body_" + std::to_string(scene.bodies.size());
        scene.bodies.push_back({name, scene.meshes.size(), "stuff", 1.0, moves});
        scene.meshes.push_back(mesh);
        looks.push_back(look);
        frame.worldFromAsset.push_back(pose);
    }
    void add(const TriMesh& mesh, const Pose& pose, const Look& look)
    {
        add(SceneMesh{"mesh", mesh.points, mesh.triangles}, pose, look);
    }
    void addGround(const Vec3& normal = Vec3::UnitY())
    {
        const Quat turn = Quat::FromTwoVectors(Vec3::UnitY(), normal);
        SceneMesh square{"ground", Points(3, 4), Triangles(3, 2)};
        square.isPlane = true;
        square.points << -5, -5, 5, 5, 0, 0, 0, 0, -5, 5, 5, -5;
        square.triangles << 0, 0, 1, 2, 2, 3;
        add(square, {Vec3::Zero(), turn}, {Vec3::Constant(0.4), 0.9}, false);
    }

    Image draw(const Camera& camera, const RasterSettings& settings = {}) const
    {
        Rasterizer rasterizer(scene, looks, settings);
        return rasterizer.draw(frame, camera, kWidth, kHeight);
    }
};

Camera lookingFrom(const Vec3& eye)
{
    Camera camera;
    camera.eye = eye;
    return camera;
}

const Look kRed = {{0.8, 0.05, 0.04}, 0.9};

/// Torus, box and poles on the ground: enough edges and shadows for pictures to differ in.
Stage smallHeap()
{
    Stage stage;
    stage.addGround();
    stage.add(makeCylinder(0.2, 4.0, 20, 4), {Vec3(0, 2, 0), Quat::Identity()}, {});
    for (int i = 0; i < 6; ++i) {
        const Quat turn(Eigen::AngleAxisd(0.3 * i, Vec3(0.2, 1.0, 0.1).normalized()));
        stage.add(makeTorus(1.0, 0.25, {16, 10}), {Vec3(0.1 * i, 0.25 + 0.5 * i, 0), turn}, kRed);
        stage.add(makeBox(Vec3::Ones(), {1, 1, 1}), {Vec3(-3.0 + i, 0.5, 2.0), turn}, {});
    }
    return stage;
}

TEST(Rasterizer, ARedCubeIsRedInTheMiddleAndTheSkyIsInTheCorners)
{
    Stage stage;
    stage.add(makeBox(Vec3::Ones(), {1, 1, 1}), {}, kRed);
    const Image image = stage.draw(lookingFrom({0, 0, 6}));
    const Color middle = image.at(kWidth / 2, kHeight / 2), corner = image.at(2, 2);
    EXPECT_GT(middle.x(), 0.15f);
    EXPECT_GT(middle.x(), 5.0f * middle.y());
    EXPECT_GT(middle.x(), 5.0f * middle.z());
    EXPECT_GT(corner.z(), corner.x());
    EXPECT_GT(corner.y(), 0.05f);
}

TEST(Rasterizer, ThePictureIsNotUpsideDown)
{
    Stage stage;
    stage.add(makeBox(Vec3::Ones(), {1, 1, 1}), {Vec3(-1.5, 1, 0), Quat::Identity()}, kRed);
    const Image image = stage.draw(lookingFrom({0, 0, 8}));
    const auto isRed = [&](int x, int y) { return image.at(x, y).x() > 4 * image.at(x, y).z(); };
    // 1 is 0.5 / tan(17.5°) × 180 / 8 = 35.7 pixels away from the middle.
    EXPECT_TRUE(isRed(kWidth / 2 - 53, kHeight / 2 - 36));
    EXPECT_FALSE(isRed(kWidth / 2 - 53, kHeight / 2 + 36));
    EXPECT_FALSE(isRed(kWidth / 2 + 53, kHeight / 2 - 36));
}

TEST(Rasterizer, ABodyDarkensTheGroundWhereItHidesTheSun)
{
    // The sun stands at 45° on the left; the shadow of a box at height 2 lies 2 to the right.
    RasterSettings settings;
    settings.towardSun = {-1, 1, 0};
    settings.groundLines = false;
    Stage open, covered;
    open.addGround();
    covered.addGround();
    covered.add(makeBox({0.8, 0.1, 0.8}, {1, 1, 1}), {Vec3(0, 2, 0), Quat::Identity()}, {});
    Camera camera = lookingFrom({2, 1, 6});
    camera.target = {2, 0, 0};  // the middle of the shadow is the middle of the picture
    const Image lit = open.draw(camera, settings), shaded = covered.draw(camera, settings);
    const auto ratio = [&](int x) {
        return shaded.at(x, kHeight / 2).x() / lit.at(x, kHeight / 2).x();
    };
    EXPECT_LT(ratio(kWidth / 2), 0.7f);
    EXPECT_NEAR(ratio(kWidth / 2 + 100), 1.0f, 0.02f);  // 2.1 beside it
}

TEST(Rasterizer, AShadowWiderThanThePictureReachesItsBorders)
{
    // A roof far larger than what is seen: the light's map ends at the borders of the picture, and
    // there soft edges must not find light that comes from beyond it.
    RasterSettings settings;
    settings.towardSun = {0, 1, 0};
    settings.groundLines = false;
    Stage open, covered;
    open.addGround();
    covered.addGround();
    covered.add(makeBox({400, 1, 400}, {1, 1, 1}), {Vec3(0, 30, 0), Quat::Identity()}, {});
    Camera camera = lookingFrom({0, 8, 0});
    camera.up = {0, 0, -1};
    const Image lit = open.draw(camera, settings), shaded = covered.draw(camera, settings);
    const auto ratio = [&](int x, int y) { return shaded.at(x, y).x() / lit.at(x, y).x(); };
    const float middle = ratio(kWidth / 2, kHeight / 2);
    EXPECT_LT(middle, 0.7f);
    for (int x = 0; x < kWidth; ++x)
        for (const int y : {0, kHeight - 1}) EXPECT_NEAR(ratio(x, y), middle, 0.02f) << x;
    for (int y = 0; y < kHeight; ++y)
        for (const int x : {0, kWidth - 1}) EXPECT_NEAR(ratio(x, y), middle, 0.02f) << y;
}

TEST(Rasterizer, SunlitGroundHasNoSpecks)
{
    Stage stage;
    stage.addGround();
    stage.add(makeBox(Vec3::Ones(), {1, 1, 1}), {Vec3(-40, 0.5, -40), Quat::Identity()}, {});
    stage.add(makeBox({30, 1, 30}, {1, 1, 1}), {Vec3(0, 0.5, 0), Quat::Identity()}, {});
    const Image image = stage.draw(lookingFrom({0, 9, 12}));
    // Along a row of the flat top nothing but a faint highlight may change.
    for (int x = 40; x < kWidth - 40; ++x)
        EXPECT_NEAR(image.at(x, 100).y(), image.at(x + 1, 100).y(), 0.012f) << x;
}

TEST(Rasterizer, ACubeHasFlatFacesAndASphereHasNot)
{
    RasterSettings settings;
    settings.smoothEdges = false;
    const auto spread = [&](const TriMesh& mesh) {
        Stage stage;
        stage.add(mesh, {}, kRed);
        const Image image = stage.draw(lookingFrom({0, 0, 8}), settings);
        float least = 1.0f, most = 0.0f;
        for (int y = -20; y <= 20; y += 2) {
            for (int x = -20; x <= 20; x += 2) {
                const float red = image.at(kWidth / 2 + x, kHeight / 2 + y).x();
                least = std::min(least, red);
                most = std::max(most, red);
            }
        }
        return most - least;
    };
    // 41 pixels of a face 80 wide. The sky's reflection and its blurred cover change a little.
    EXPECT_LT(spread(makeBox(Vec3::Constant(2.0), {2, 2, 2})), 0.06f);
    EXPECT_GT(spread(makeSphere(1.0, 4)), 0.15f);
}

TEST(Rasterizer, EdgesAreMixedFromBothSides)
{
    Stage stage;
    stage.add(makeBox(Vec3::Ones(), {1, 1, 1}),
              {Vec3::Zero(), Quat(Eigen::AngleAxisd(0.2, Vec3::UnitZ()))}, kRed);
    RasterSettings coarse;
    coarse.smoothEdges = false;
    const auto mixedCount = [](const Image& image) {
        int count = 0;
        for (int y = 0; y < kHeight; ++y) {
            for (int x = 0; x < kWidth; ++x) {
                const Color color = image.at(x, y);
                const float share = color.x() / color.z();  // sky: below 1, cube: above 5
                if (share > 1.3f && share < 4.5f) ++count;
            }
        }
        return count;
    };
    EXPECT_EQ(mixedCount(stage.draw(lookingFrom({0, 0, 6}), coarse)), 0);
    EXPECT_GT(mixedCount(stage.draw(lookingFrom({0, 0, 6}))), 50);
}

TEST(Rasterizer, GroundIsEndlessWhateverTheSizeOfItsSquare)
{
    Stage stage;
    stage.addGround();
    const Image image = stage.draw(lookingFrom({0, 20, 40}));
    // 5 below the middle of the picture is some 30 from the square's edge.
    const Color ground = image.at(kWidth / 2, kHeight - 2), far = image.at(2, kHeight - 2);
    EXPECT_GT(ground.x(), ground.z() * 0.95f);
    EXPECT_NEAR(ground.y(), far.y(), 0.1f);
}

// What an artist has drawn as one square was taken for a plane, and had no end.
TEST(Rasterizer, ASquareThatIsAMeshEndsWhereItEnds)
{
    Stage stage;
    stage.addGround();
    stage.scene.meshes.back().isPlane = false;
    const Image image = stage.draw(lookingFrom({0, 20, 40}));
    const Color middle = image.at(kWidth / 2, kHeight / 2),
                beyond = image.at(kWidth / 2, kHeight - 2);
    EXPECT_GT(middle.x(), middle.z() * 0.95f);
    EXPECT_LT(beyond.x(), beyond.z() * 0.95f) << "the sky below it";
}

TEST(Rasterizer, BareGroundIsAsBrightAsGroundBesideABody)
{
    Stage bare, beside;
    bare.addGround();
    beside.addGround();
    beside.add(makeBox(Vec3::Ones(), {1, 1, 1}), {Vec3(-4, 0.5, 0), Quat::Identity()}, kRed);
    const Image a = bare.draw(lookingFrom({0, 5, 8})), b = beside.draw(lookingFrom({0, 5, 8}));
    for (int y = kHeight / 2; y < kHeight; ++y)
        EXPECT_NEAR(a.at(kWidth - 40, y).x(), b.at(kWidth - 40, y).x(), 0.01f) << y;
}

TEST(Rasterizer, PlanesAreNotSeenFromInsideTheSolid)
{
    Stage empty, below;
    below.addGround();
    empty.add(makeBox(Vec3::Ones(), {1, 1, 1}), {Vec3(0, -3, 0), Quat::Identity()}, kRed);
    below.add(makeBox(Vec3::Ones(), {1, 1, 1}), {Vec3(0, -3, 0), Quat::Identity()}, kRed);
    Camera camera = lookingFrom({0, -5, 8});
    camera.target = {0, -3, 0};
    const Image a = empty.draw(camera), b = below.draw(camera);
    EXPECT_EQ(toSrgbBytes(a)[0], toSrgbBytes(b)[0]);
}

TEST(Rasterizer, ZUpScenesLookLikeTheirYUpTwins)
{
    // Turned by a quarter about x, +y becomes +z: every light must turn with it.
    const Quat turn(Eigen::AngleAxisd(0.5 * 3.14159265358979, Vec3::UnitX()));
    Stage yUp = smallHeap(), zUp = smallHeap();
    zUp.scene.zUp = true;
    for (Pose& pose : zUp.frame.worldFromAsset) pose = Pose{Vec3::Zero(), turn} * pose;
    Camera camera = lookingFrom({8, 5, 9});
    const Image a = yUp.draw(camera);
    camera.eye = turn * camera.eye;
    camera.up = Vec3::UnitZ();
    const Image b = zUp.draw(camera);
    double difference = 0.0;
    for (std::size_t i = 0; i < a.values.size(); ++i)
        difference += std::abs(a.values[i] - b.values[i]);
    EXPECT_LT(difference / static_cast<double>(a.values.size()), 0.004);
}

TEST(Rasterizer, DrawingAgainGivesTheSameBytes)
{
    const Stage stage = smallHeap();
    Rasterizer rasterizer(stage.scene, stage.looks);
    const Camera camera = lookingFrom({8, 5, 9});
    const Image first = rasterizer.draw(stage.frame, camera, kWidth, kHeight);
    rasterizer.draw(stage.frame, lookingFrom({-3, 9, 1}), 64, 200);  // leaves no trace
    const Image second = rasterizer.draw(stage.frame, camera, kWidth, kHeight);
    EXPECT_EQ(first.values, second.values);
    EXPECT_EQ(first.values, stage.draw(camera).values);
}

TEST(Rasterizer, ABodyThatIsNowhereSpoilsNothing)
{
    Stage stage = smallHeap();
    const Camera camera = lookingFrom({8, 5, 9});
    const Image expected = stage.draw(camera);
    const Vec3 nowhere = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    stage.add(makeTorus(1.0, 0.25, {16, 10}), {nowhere, Quat::Identity()}, kRed);
    EXPECT_EQ(stage.draw(camera).values, expected.values);
}

TEST(Rasterizer, ABodyThatIsNotBornCastsNoShadowAndDarkensNoGround)
{
    Stage stage = smallHeap(), more = smallHeap();
    const Camera camera = lookingFrom({8, 5, 9});
    // Above the heap, out of the picture, where both its maps would see it.
    more.add(makeBox({6, 1, 6}, {1, 1, 1}), {Vec3(-1, 9, 1), Quat::Identity()}, kRed);
    EXPECT_NE(more.draw(camera).values, stage.draw(camera).values);
    more.scene.bodies.back().birthFrame = more.frame.frame + 1;
    EXPECT_EQ(more.draw(camera).values, stage.draw(camera).values);
}

TEST(Rasterizer, AnEmptySceneIsAllSky)
{
    const Image image = Stage{}.draw(lookingFrom({3, 2, 5}));
    for (const float value : image.values) EXPECT_GT(value, 0.02f);
}

TEST(Rasterizer, FarFromTheWorldOriginNothingShakes)
{
    // The same scene a million units away; in single precision a unit is then 1/16.
    Stage stage = smallHeap();
    Camera camera = lookingFrom({8, 5, 9});
    RasterSettings settings;
    settings.groundLines = false;
    const Image expected = stage.draw(camera, settings);
    const Vec3 away(1e6, 0.0, -2e6);
    for (Pose& pose : stage.frame.worldFromAsset) pose.position += away;
    camera.eye += away;
    camera.target += away;
    const Image moved = stage.draw(camera, settings);
    double difference = 0.0;
    for (std::size_t i = 0; i < moved.values.size(); ++i)
        difference += std::abs(moved.values[i] - expected.values[i]);
    EXPECT_LT(difference / static_cast<double>(moved.values.size()), 1e-5);
}

// The number of threads is fixed when OpenGL starts, so each number needs a process of its own:
// this program runs itself again, asking for the one test below that leaves its picture behind.
TEST(Rasterizer, DISABLED_LeavesAPicture)
{
    const char* path = std::getenv("SCREE_TEST_PICTURE");
    ASSERT_NE(path, nullptr);
    test::storePng(path, smallHeap().draw(lookingFrom({8, 5, 9})));
}

TEST(Rasterizer, AnyNumberOfThreadsGivesTheSamePicture)
{
    const test::TemporaryFolder folder;
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    std::vector<std::vector<float>> pictures;
    for (const char* threads : {"0", "1", "2", "5"}) {
        const auto path = folder / (std::string(threads) + ".png");
        const std::string command =
            "LP_NUM_THREADS=" + std::string(threads) + " SCREE_TEST_PICTURE='" + path.string() +
            "' '" + self +
            "' --gtest_also_run_disabled_tests --gtest_filter='*LeavesAPicture' > /dev/null";
        ASSERT_EQ(std::system(command.c_str()), 0) << command;
        pictures.push_back(test::loadPng(path).values);
    }
    for (const auto& picture : pictures) EXPECT_EQ(picture, pictures.front());
}

}  // namespace
}  // namespace scree
