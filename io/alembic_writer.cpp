#include "io/alembic_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/tri_mesh.h"
#include "core/math/rotation.h"
#include "core/picture/camera_motion.h"
#include "core/picture/shaded_mesh.h"
#include "io/alembic_archive.h"
#include "io/byte_order.h"
#include "io/camera_names.h"
#include "io/camera_pose.h"
#include "io/number_text.h"

namespace scree {

namespace {

namespace fs = std::filesystem;

/// A transform as Alembic has it: 4×4 row by row for row vectors, so the translation is the last
/// row.
using Channels = std::array<double, 16>;

constexpr Channels kIdentity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
// (x, y, z) → (x, z, −y): the shot's +z becomes +y.
constexpr Channels kYUpFromZUp = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};

constexpr char kMatrixOp = 0x30;
constexpr double kChannelMoves = 1e-12;  // Alembic's own threshold for naming a channel animated

constexpr std::string_view kXformSchema = "schema=AbcGeom_Xform_v3";
constexpr std::string_view kXformTitle = ";schemaObjTitle=AbcGeom_Xform_v3:.xform";
constexpr std::string_view kMeshSchema =
    "schema=AbcGeom_PolyMesh_v1;schemaBaseType=AbcGeom_GeomBase_v1";
constexpr std::string_view kMeshTitle = ";schemaObjTitle=AbcGeom_PolyMesh_v1:.geom";
constexpr std::string_view kFaceSetSchema =
    "schema=AbcGeom_FaceSet_v1;schemaBaseType=AbcGeom_GeomBase_v1";
constexpr std::string_view kFaceSetTitle = ";schemaObjTitle=AbcGeom_FaceSet_v1:.faceset";
constexpr std::string_view kCameraSchema = "schema=AbcGeom_Camera_v1";
constexpr std::string_view kCameraTitle = ";schemaObjTitle=AbcGeom_Camera_v1:.geom";
constexpr std::string_view kNormalMetadata =
    "arrayExtent=1;geoScope=fvr;interpretation=normal;isGeomParam=true;podExtent=3;"
    "podName=float32_t";
constexpr std::string_view kUvMetadata =
    "arrayExtent=1;geoScope=fvr;interpretation=vector;isGeomParam=true;podExtent=2;"
    "podName=float32_t";
constexpr std::string_view kPointMetadata = "geoScope=vtx;interpretation=point";
constexpr std::string_view kBoxMetadata = "interpretation=box";

// Matrices, although a translation with rotation axis and angle would take half the space: a matrix
// needs no sine and no choice of sign, so a reader gets the pose itself, not a way back to it.
Channels channelsOf(const Pose& parentFromChild)
{
    Channels channels = kIdentity;
    const Mat3 rotation = parentFromChild.orientation.toRotationMatrix();
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) {
            channels[static_cast<std::size_t>(4 * column + row)] = rotation(row, column);
        }
        channels[static_cast<std::size_t>(12 + row)] = parentFromChild.position[row];
    }
    return channels;
}

/// Where a body will be born, in no size. Blender shows what is not `visible` all the same, and
/// coins that have yet to be poured would hang in the air.
Channels hiddenAt(const Pose& parentFromChild)
{
    Channels channels = channelsOf(parentFromChild);
    for (const std::size_t column : {0, 4, 8}) std::fill_n(&channels[column], 3, 0.0);
    return channels;
}

std::string zeroTerminated(const std::string& text)
{
    return std::string(text.c_str(), std::string_view(text.c_str()).size() + 1);
}

AlembicLayout scalarLayout(std::string name, AlembicType type, int extent = 1, int sampling = 0)
{
    return {std::move(name), AlembicKind::scalar, type, extent, sampling, ""};
}

AlembicLayout arrayLayout(std::string name, AlembicType type, int extent = 1, int sampling = 0)
{
    return {std::move(name), AlembicKind::array, type, extent, sampling, ""};
}

/// What is kept of a body's transform while frames come.
struct TransformTrack {
    Channels first = kIdentity;
    Channels last = kIdentity;
    std::uint16_t movingChannels = 0;  // bit k: channel k has left its first value
    bool isIdentity = true;
    SampleTrack samples;
};

/// A mesh's samples, written once. Bodies of one shape have mesh objects of their own whose
/// properties point at these blocks. Alembic's instances would say the same, but some readers lose
/// them.
struct MeshSamples {
    AlembicSample bounds, points, normals, faceIndices, faceCounts;
    AlembicSample uvs;       // if hasUvs
    AlembicSample allFaces;  // 0 … #F − 1, for the face set
    bool hasFaces = false, hasUvs = false;
};

/// A normal for every corner in the file's order. Readers take a mesh without normals for smooth
/// all over, edges of cubes included.
Eigen::Matrix3Xf clockwiseNormals(const SceneMesh& mesh)
{
    Eigen::Matrix3Xf normals = cornerNormals(mesh);
    for (Eigen::Index f = 0; f < mesh.triangles.cols(); ++f)
        normals.col(3 * f + 1).swap(normals.col(3 * f + 2));
    return normals;
}

/// The sixteen numbers of Alembic's camera.
std::array<double, 16> lensOf(const SceneCamera& camera, const SceneDescription& scene)
{
    constexpr double kFilmWidth = 3.6;  // [cm], of a 35 mm camera
    const double filmHeight = kFilmWidth / scene.aspect;
    double sine = 0.0, cosine = 0.0;
    sinCos(camera.fovDegrees * kPi / 360.0, sine, cosine);
    const double focalLength = 0.5 * filmHeight * cosine / sine;  // [cm]
    const double toTarget = (camera.eye - camera.target).norm();
    const double distance = toTarget > 0.0 ? toTarget : 1.0;
    return {
        10.0 * focalLength,  // focal length [mm]
        kFilmWidth,
        0.0,
        filmHeight,
        0.0,  // film and its shifts [cm]
        1.0,
        0.0,
        0.0,
        0.0,
        0.0,  // squeeze, overscan on four sides
        5.6,
        100.0 * scene.metresPerUnit * distance,  // f-stop, focus [cm]
        0.0,
        0.5 / scene.framesPerSecond,  // shutter opens, closes [s]
        1e-3 * distance,
        1e3 * distance,  // nearest, farthest [shot's unit]
    };
}

class AlembicWriter final : public FrameWriter {
public:
    explicit AlembicWriter(fs::path output) : output_(std::move(output)) {}

    bool holdsSubframes() const override { return true; }

private:
    void beginScene(const SceneDescription& scene, int firstFrame, int frameCount) override;
    void writeFrame(const SceneFrame& frame) override;
    void finishScene(const FinishWatch& watch) override;

    MeshSamples writeMesh(const SceneMesh& mesh);
    void addSample(TransformTrack& track, const Channels& channels);
    AlembicObject writeBody(std::size_t body);
    SampleTrack visibilityOf(const SceneBody& body);
    AlembicObject writeShape(const std::string& name, const MeshSamples& mesh,
                             const std::string& material);
    AlembicObject writeMaterial(const std::string& name, const MeshSamples& mesh);
    AlembicObject writeCamera(const SceneCamera& camera, const std::string& name);
    AlembicProperty writeLens(const std::vector<SceneCamera>& samples);
    AlembicProperty textProperty(const std::string& name, const std::string& text);
    AlembicObject writeTransform(const std::string& name, const TransformTrack& track, bool moves,
                                 const std::vector<AlembicProperty>& userProperties,
                                 std::span<const AlembicObject> children,
                                 const SampleTrack& visible = {});
    AlembicProperty writeMovingChannels(const TransformTrack& track);

    fs::path output_;
    const SceneDescription* scene_ = nullptr;
    int firstFrame_ = 0, frameCount_ = 0;
    std::optional<AlembicArchive> archive_;
    int everySample_ = 0;  // index of the time sampling of all that moves
    std::vector<MeshSamples> meshes_;
    std::vector<TransformTrack> bodies_;

    // The same for all transforms: "follows the parent" and "is one matrix". Bodies that move need
    // as many of these samples as they have matrices, or readers lose the motion.
    AlembicSample inheritsSample_, opsSample_;
    SampleTrack inheritsEverySample_, opsEverySample_;
};

void AlembicWriter::beginScene(const SceneDescription& scene, int firstFrame, int frameCount)
{
    scene_ = &scene;
    firstFrame_ = firstFrame;
    frameCount_ = frameCount;
    archive_.emplace(output_);
    std::vector<double> times;
    for (const double offset : offsets())
        times.push_back((firstFrame + offset) / scene.framesPerSecond);
    everySample_ = archive_->addCyclicSampling(std::move(times), 1.0 / scene.framesPerSecond);
    inheritsSample_ = archive_->writeScalar(std::string_view("\x01", 1));
    opsSample_ = archive_->writeScalar(std::string_view(&kMatrixOp, 1));
    bodies_.resize(scene.bodies.size());

    // Write each mesh that some body uses; a block that nobody points to would be waste.
    std::vector<bool> isWritten(scene.meshes.size(), false);
    meshes_.resize(scene.meshes.size());
    for (const SceneBody& body : scene.bodies) {
        if (isWritten[body.mesh]) continue;
        meshes_[body.mesh] = writeMesh(scene.meshes[body.mesh]);
        isWritten[body.mesh] = true;
    }
}

MeshSamples AlembicWriter::writeMesh(const SceneMesh& mesh)
{
    // Bounds are those of the rounded points, so that they hold what a reader sees.
    const Eigen::Matrix3Xf points = mesh.points.cast<float>();
    Eigen::Matrix<double, 6, 1> bounds = Eigen::Matrix<double, 6, 1>::Zero();
    if (points.cols() > 0) {
        const Eigen::Vector3f lowest = points.rowwise().minCoeff();
        const Eigen::Vector3f highest = points.rowwise().maxCoeff();
        bounds << lowest.cast<double>(), highest.cast<double>();
    }

    // Alembic's faces are clockwise seen from outside.
    TriMesh clockwise{mesh.points, mesh.triangles, mesh.cornerUvs};
    turnInsideOut(clockwise);
    const auto faceCount = static_cast<std::size_t>(mesh.triangles.cols());
    const std::vector<std::int32_t> cornersPerFace(faceCount, 3);
    std::vector<std::int32_t> allFaces(faceCount);
    std::iota(allFaces.begin(), allFaces.end(), 0);

    MeshSamples samples;
    samples.hasFaces = faceCount > 0;
    samples.normals = archive_->writeArray(bytesOf(clockwiseNormals(mesh)), 3 * faceCount);
    samples.hasUvs = mesh.cornerUvs.cols() > 0;
    if (samples.hasUvs) {
        samples.uvs = archive_->writeArray(bytesOf(clockwise.cornerUvs), 3 * faceCount);
    }
    samples.allFaces = archive_->writeArray(bytesOf(allFaces), faceCount);
    samples.bounds = archive_->writeScalar(bytesOf(bounds));
    samples.points =
        archive_->writeArray(bytesOf(points), static_cast<std::uint64_t>(points.cols()));
    samples.faceIndices = archive_->writeArray(bytesOf(clockwise.triangles), 3 * faceCount);
    samples.faceCounts = archive_->writeArray(bytesOf(cornersPerFace), faceCount);
    return samples;
}

void AlembicWriter::writeFrame(const SceneFrame& frame)
{
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
        TransformTrack& track = bodies_[body];
        if (!scene_->bodies[body].moves && track.samples.count() > 0) continue;
        const Pose& pose = frame.worldFromAsset[body];
        const bool isHidden = !isSeen(scene_->bodies[body], frame.frame);
        addSample(track, isHidden ? hiddenAt(pose) : channelsOf(pose));
    }
    inheritsEverySample_.append(inheritsSample_);
    opsEverySample_.append(opsSample_);
}

void AlembicWriter::addSample(TransformTrack& track, const Channels& channels)
{
    track.isIdentity = track.isIdentity && channels == kIdentity;
    if (track.samples.count() == 0) {
        track.first = channels;
    } else if (bytesOf(channels) == bytesOf(track.last)) {
        track.samples.repeatLast();
        return;
    }
    track.samples.append(archive_->writeScalar(bytesOf(channels)));
    track.last = channels;
    for (std::size_t k = 0; k < channels.size(); ++k) {
        if (std::abs(channels[k] - track.first[k]) <= kChannelMoves) continue;
        track.movingChannels = static_cast<std::uint16_t>(track.movingChannels | 1u << k);
    }
}

void AlembicWriter::finishScene(const FinishWatch& watch)
{
    std::vector<AlembicObject> children;
    children.reserve(bodies_.size() + scene_->cameras.size());
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
        watch(static_cast<double>(body) / static_cast<double>(bodies_.size()));
        children.push_back(writeBody(body));
    }
    const std::vector<std::string> names = cameraNames(*scene_);
    for (std::size_t k = 0; k < names.size(); ++k)
        children.push_back(writeCamera(scene_->cameras[k], names[k]));

    TransformTrack axes;
    addSample(axes, scene_->zUp ? kYUpFromZUp : kIdentity);
    const std::array<double, 1> metresPerUnit = {scene_->metresPerUnit};
    const std::vector<AlembicProperty> userProperties = {
        archive_->writeConstant(scalarLayout("metresPerUnit", AlembicType::f64),
                                bytesOf(metresPerUnit)),
        textProperty("upAxisOfShot", scene_->zUp ? "z" : "y"),
    };
    const AlembicObject root = writeTransform(scene_->name, axes, false, userProperties, children);

    // No date: equal input gives equal bytes.
    archive_->finish(
        std::span(&root, 1),
        "_ai_AlembicVersion=layout of Alembic 1.8.12;_ai_Application=Scree;_ai_DCC_FPS=" +
            numberText(scene_->framesPerSecond));
}

AlembicProperty AlembicWriter::textProperty(const std::string& name, const std::string& text)
{
    return archive_->writeConstant(scalarLayout(name, AlembicType::string), zeroTerminated(text));
}

AlembicObject AlembicWriter::writeBody(std::size_t index)
{
    const SceneBody& body = scene_->bodies[index];
    const AlembicObject shape = writeShape(body.name + "Shape", meshes_[body.mesh], body.material);

    const std::array<double, 1> mass = {body.mass};
    const std::array<std::int32_t, 1> id = {static_cast<std::int32_t>(index)};
    const std::array<std::int32_t, 1> birth = {body.birthFrame == kFromTheStart ? firstFrame_
                                                                                : body.birthFrame};
    std::vector<AlembicProperty> userProperties;
    if (body.mass > 0.0) {
        userProperties.push_back(
            archive_->writeConstant(scalarLayout("mass", AlembicType::f64), bytesOf(mass)));
    }
    if (!body.material.empty()) userProperties.push_back(textProperty("material", body.material));
    userProperties.push_back(textProperty("shape", scene_->meshes[body.mesh].name));
    userProperties.push_back(
        archive_->writeConstant(scalarLayout("bodyId", AlembicType::i32), bytesOf(id)));
    userProperties.push_back(
        archive_->writeConstant(scalarLayout("birthFrame", AlembicType::i32), bytesOf(birth)));
    return writeTransform(body.name, bodies_[index], body.moves, userProperties,
                          std::span(&shape, 1), visibilityOf(body));
}

/// Alembic's own visibility, a sample for each of time; none for a body that is always there.
SampleTrack AlembicWriter::visibilityOf(const SceneBody& body)
{
    SampleTrack track;
    if (isSeen(body, firstFrame_)) return track;
    // A sample that nothing refers to would be waste.
    const AlembicSample hidden = archive_->writeScalar(std::string_view("\0", 1));
    AlembicSample shown;
    const int end = firstFrame_ + frameCount_;
    if (isSeen(body, end - 1)) shown = archive_->writeScalar(std::string_view("\x01", 1));
    for (int frame = firstFrame_; frame < end; ++frame) {
        for (std::size_t k = 0; k < offsets().size(); ++k) {
            track.append(isSeen(body, frame) ? shown : hidden);
        }
    }
    return track;
}

AlembicObject AlembicWriter::writeShape(const std::string& name, const MeshSamples& mesh,
                                        const std::string& material)
{
    AlembicLayout bounds = scalarLayout(".selfBnds", AlembicType::f64, 6);
    bounds.metadata = kBoxMetadata;
    AlembicLayout points = arrayLayout("P", AlembicType::f32, 3);
    points.metadata = kPointMetadata;

    AlembicLayout normals = arrayLayout("N", AlembicType::f32, 3);
    normals.metadata = kNormalMetadata;

    std::vector<AlembicProperty> properties = {
        archive_->writeProperty(bounds, SampleTrack(mesh.bounds)),
        archive_->writeProperty(points, SampleTrack(mesh.points)),
        archive_->writeProperty(normals, SampleTrack(mesh.normals)),
        archive_->writeProperty(arrayLayout(".faceIndices", AlembicType::i32),
                                SampleTrack(mesh.faceIndices)),
        archive_->writeProperty(arrayLayout(".faceCounts", AlembicType::i32),
                                SampleTrack(mesh.faceCounts)),
    };
    if (mesh.hasUvs) {
        AlembicLayout uvs = arrayLayout("uv", AlembicType::f32, 2);
        uvs.metadata = kUvMetadata;
        properties.push_back(archive_->writeProperty(uvs, SampleTrack(mesh.uvs)));
    }
    const AlembicProperty geometry =
        archive_->writeCompound(".geom", std::string(kMeshSchema), properties);
    const std::string metadata = std::string(kMeshSchema) + std::string(kMeshTitle);
    if (material.empty() || !mesh.hasFaces)
        return archive_->writeObject(name, metadata, std::span(&geometry, 1), {});
    const AlembicObject faces = writeMaterial(material, mesh);
    return archive_->writeObject(name, metadata, std::span(&geometry, 1), std::span(&faces, 1));
}

/// A face set of all faces: the one way of naming a material that Alembic's own schemas know.
/// Blender makes a material of it, Houdini a group.
AlembicObject AlembicWriter::writeMaterial(const std::string& name, const MeshSamples& mesh)
{
    AlembicLayout bounds = scalarLayout(".selfBnds", AlembicType::f64, 6);
    bounds.metadata = kBoxMetadata;
    const AlembicProperty properties[] = {
        archive_->writeProperty(bounds, SampleTrack(mesh.bounds)),
        archive_->writeProperty(arrayLayout(".faces", AlembicType::i32),
                                SampleTrack(mesh.allFaces)),
    };
    const AlembicProperty faceSet =
        archive_->writeCompound(".faceset", std::string(kFaceSetSchema), properties);
    const std::string metadata = std::string(kFaceSetSchema) + std::string(kFaceSetTitle);
    return archive_->writeObject(name, metadata, std::span(&faceSet, 1), {});
}

AlembicProperty AlembicWriter::writeLens(const std::vector<SceneCamera>& samples)
{
    const auto first = lensOf(samples.front(), *scene_);
    SampleTrack track(archive_->writeScalar(bytesOf(first)));
    auto last = first;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const auto now = lensOf(samples[i], *scene_);
        if (now == last)
            track.repeatLast();
        else
            track.append(archive_->writeScalar(bytesOf(now)));
        last = now;
    }
    const int sampling = samples.size() > 1 ? everySample_ : 0;
    return archive_->writeProperty(scalarLayout(".core", AlembicType::f64, 16, sampling), track);
}

AlembicObject AlembicWriter::writeCamera(const SceneCamera& camera, const std::string& name)
{
    const std::vector<SceneCamera> samples =
        moves(camera) ? camerasAt(camera, times(), scene_->zUp)
                      : camerasAt(camera, {times().front()}, scene_->zUp);
    const AlembicProperty property = writeLens(samples);
    const AlembicProperty geometry =
        archive_->writeCompound(".geom", std::string(kCameraSchema), std::span(&property, 1));
    const AlembicObject lens = archive_->writeObject(
        name + "Camera", std::string(kCameraSchema) + std::string(kCameraTitle),
        std::span(&geometry, 1), {});

    TransformTrack place;
    for (const Pose& pose : worldFromCameras(samples, scene_->zUp))
        addSample(place, channelsOf(pose));
    return writeTransform(name, place, moves(camera), {}, std::span(&lens, 1));
}

AlembicObject AlembicWriter::writeTransform(const std::string& name, const TransformTrack& track,
                                            bool moves,
                                            const std::vector<AlembicProperty>& userProperties,
                                            std::span<const AlembicObject> children,
                                            const SampleTrack& visible)
{
    const int sampling = moves ? everySample_ : 0;
    const SampleTrack& inherits = moves ? inheritsEverySample_ : SampleTrack(inheritsSample_);
    const SampleTrack& ops = moves ? opsEverySample_ : SampleTrack(opsSample_);

    std::vector<AlembicProperty> properties = {
        archive_->writeProperty(scalarLayout(".inherits", AlembicType::boolean, 1, sampling),
                                inherits),
        archive_->writeProperty(scalarLayout(".ops", AlembicType::u8), ops),
        archive_->writeProperty(scalarLayout(".vals", AlembicType::f64, 16, sampling),
                                track.samples),
    };
    if (!track.isIdentity) {
        const AlembicLayout layout = scalarLayout("isNotConstantIdentity", AlembicType::boolean);
        properties.push_back(archive_->writeConstant(layout, std::string_view("\x01", 1)));
    }
    if (!userProperties.empty()) {
        properties.push_back(archive_->writeCompound(".userProperties", "", userProperties));
    }
    if (track.movingChannels != 0) properties.push_back(writeMovingChannels(track));

    std::vector<AlembicProperty> ofObject = {
        archive_->writeCompound(".xform", std::string(kXformSchema), properties)};
    if (visible.count() > 0) {
        ofObject.push_back(archive_->writeProperty(
            scalarLayout("visible", AlembicType::i8, 1, everySample_), visible));
    }
    const std::string metadata = std::string(kXformSchema) + std::string(kXformTitle);
    return archive_->writeObject(name, metadata, ofObject, children);
}

AlembicProperty AlembicWriter::writeMovingChannels(const TransformTrack& track)
{
    std::vector<std::uint32_t> channels;
    for (std::uint32_t k = 0; k < track.first.size(); ++k) {
        if (track.movingChannels >> k & 1u) channels.push_back(k);
    }
    const AlembicSample sample = archive_->writeArray(bytesOf(channels), channels.size());
    return archive_->writeProperty(arrayLayout(".animChans", AlembicType::u32, 1, everySample_),
                                   SampleTrack(sample));
}

}  // namespace

std::unique_ptr<FrameWriter> makeAlembicWriter(const fs::path& output)
{
    return std::make_unique<AlembicWriter>(output);
}

}  // namespace scree
