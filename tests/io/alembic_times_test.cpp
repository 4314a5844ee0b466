// Alembic files of others, in which a transform and what is below it are not sampled at the same
// times.
#include <gtest/gtest.h>

#include <array>
#include <functional>

#include "core/math/rotation.h"
#include "core/scene/motion_script.h"
#include "io/alembic_archive.h"
#include "io/byte_order.h"
#include "io/shot_parser.h"
#include "tests/support/support.h"

namespace scree {
namespace {

using Channels = std::array<double, 16>;

/// As Alembic has it: row by row for row vectors.
Channels channelsOf(const Pose& pose)
{
    const Mat3 R = pose.orientation.toRotationMatrix();
    const Vec3& x = pose.position;
    return {R(0, 0), R(1, 0), R(2, 0), 0, R(0, 1), R(1, 1), R(2, 1), 0,
            R(0, 2), R(1, 2), R(2, 2), 0, x.x(),   x.y(),   x.z(),   1};
}

/// A transform with `count` samples every `step` seconds from 0 on.
AlembicObject transformOf(AlembicArchive& archive, const std::string& name, int count, double step,
                          const std::function<Pose(double)>& poseAt,
                          std::span<const AlembicObject> children)
{
    const int sampling = archive.addCyclicSampling({0.0}, step);
    SampleTrack inherits, ops, values;
    const AlembicSample yes = archive.writeScalar(std::string_view("\x01", 1));
    const AlembicSample matrix = archive.writeScalar(std::string_view("\x30", 1));
    for (int i = 0; i < count; ++i) {
        inherits.append(yes);
        ops.append(matrix);
        values.append(archive.writeScalar(bytesOf(channelsOf(poseAt(i * step)))));
    }
    const AlembicProperty properties[] = {
        archive.writeProperty(
            {".inherits", AlembicKind::scalar, AlembicType::boolean, 1, sampling, ""}, inherits),
        archive.writeProperty({".ops", AlembicKind::scalar, AlembicType::u8, 1, 0, ""}, ops),
        archive.writeProperty({".vals", AlembicKind::scalar, AlembicType::f64, 16, sampling, ""},
                              values),
    };
    const AlembicProperty xform =
        archive.writeCompound(".xform", "schema=AbcGeom_Xform_v3", properties);
    return archive.writeObject(name,
                               "schema=AbcGeom_Xform_v3;schemaObjTitle=AbcGeom_Xform_v3:.xform",
                               {&xform, 1}, children);
}

/// A tetrahedron of edge 1, faces clockwise.
AlembicObject meshOf(AlembicArchive& archive)
{
    const std::array<float, 12> points = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    const std::array<std::int32_t, 12> indices = {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};
    const std::array<std::int32_t, 4> counts = {3, 3, 3, 3};
    const AlembicProperty properties[] = {
        archive.writeProperty({"P", AlembicKind::array, AlembicType::f32, 3, 0, ""},
                              SampleTrack(archive.writeArray(bytesOf(points), 4))),
        archive.writeProperty({".faceIndices", AlembicKind::array, AlembicType::i32, 1, 0, ""},
                              SampleTrack(archive.writeArray(bytesOf(indices), 12))),
        archive.writeProperty({".faceCounts", AlembicKind::array, AlembicType::i32, 1, 0, ""},
                              SampleTrack(archive.writeArray(bytesOf(counts), 4))),
    };
    const std::string schema = "schema=AbcGeom_PolyMesh_v1;schemaBaseType=AbcGeom_GeomBase_v1";
    const AlembicProperty geom = archive.writeCompound(".geom", schema, properties);
    return archive.writeObject("meshShape", schema + ";schemaObjTitle=AbcGeom_PolyMesh_v1:.geom",
                               {&geom, 1}, {});
}

/// The animation of the mesh under two transforms.
MotionScript importedScript(const std::filesystem::path& file)
{
    const Shot shot = parseShotText(
        "scree = 1\n[shot]\nname = \"s\"\nframes = \"0-24\"\n[material.wood]\n[[import]]\nfile = "
        "\"" +
            file.string() + "\"\nmaterial = \"wood\"\nmotion = \"keyed\"\n",
        "s.toml");
    return MotionScript(shot.bodies.at(0).keys, shot.bodies.at(0).interpolation);
}

// A carriage with two keys and wheels with one a frame made the whole file unreadable: "bake both
// at every frame".
TEST(AlembicTimes, AChildSampledMoreOftenThanItsParentIsCarriedSteadily)
{
    const test::TemporaryFolder folder;
    AlembicArchive archive(folder / "x.abc");
    const AlembicObject mesh = meshOf(archive);
    const auto risen = [](double t) { return Pose{Vec3(0, 4 * t, 0), Quat::Identity()}; };
    const AlembicObject child = transformOf(archive, "child", 5, 0.25, risen, {&mesh, 1});
    const auto turned = [](double t) {
        return Pose{Vec3(2 * t, 0, 0), Quat(Eigen::AngleAxisd(kPi * t, Vec3::UnitZ()))};
    };
    const AlembicObject parent = transformOf(archive, "parent", 3, 0.5, turned, {&child, 1});
    archive.finish({&parent, 1}, "_ai_Application=test");

    const MotionScript script = importedScript(folder / "x.abc");
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const Pose expected = turned(t) * risen(t), pose = script.at(t);
        EXPECT_LT((pose.position - expected.position).norm(), 1e-9) << t;
        EXPECT_LT(pose.orientation.angularDistance(expected.orientation), 1e-9) << t;
    }
}

TEST(AlembicTimes, WhoStopsEarlierStandsStill)
{
    const test::TemporaryFolder folder;
    AlembicArchive archive(folder / "x.abc");
    const AlembicObject mesh = meshOf(archive);
    const auto risen = [](double t) { return Pose{Vec3(0, t, 0), Quat::Identity()}; };
    const auto gone = [](double t) { return Pose{Vec3(t, 0, 0), Quat::Identity()}; };
    const AlembicObject child = transformOf(archive, "child", 3, 0.25, risen, {&mesh, 1});
    const AlembicObject parent = transformOf(archive, "parent", 4, 0.3, gone, {&child, 1});
    archive.finish({&parent, 1}, "_ai_Application=test");

    const MotionScript script = importedScript(folder / "x.abc");
    for (const double t : {0.0, 0.25, 0.3, 0.5, 0.6, 0.9, 1.0}) {
        const Vec3 expected(std::min(t, 0.9), std::min(t, 0.5), 0);
        EXPECT_LT((script.at(t).position - expected).norm(), 1e-9) << t;
    }
}

}  // namespace
}  // namespace scree
