#include "io/alembic_writer.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/alembic_archive.h"
#include "io/byte_order.h"

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

std::string shortestText(double value)
{
    std::array<char, 32> letters;
    const auto end = std::to_chars(letters.data(), letters.data() + letters.size(), value).ptr;
    return std::string(letters.data(), end);
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
    AlembicSample bounds, points, faceIndices, faceCounts;
};

class AlembicWriter final : public FrameWriter {
public:
    explicit AlembicWriter(fs::path output) : output_(std::move(output)) {}

private:
    void beginScene(const SceneDescription& scene, int firstFrame, int frameCount) override;
    void writeFrame(const SceneFrame& frame) override;
    void finishScene() override;

    MeshSamples writeMesh(const SceneMesh& mesh);
    void addSample(TransformTrack& track, const Channels& channels);
    AlembicObject writeBody(const SceneBody& body, const TransformTrack& track);
    AlembicObject writeShape(const std::string& name, const MeshSamples& mesh);
    AlembicObject writeTransform(const std::string& name, const TransformTrack& track, bool moves,
                                 const std::vector<AlembicProperty>& userProperties,
                                 std::span<const AlembicObject> children);
    AlembicProperty writeMovingChannels(const TransformTrack& track);

    fs::path output_;
    const SceneDescription* scene_ = nullptr;
    std::optional<AlembicArchive> archive_;
    int everyFrame_ = 0;  // index of the time sampling with one sample per frame
    std::vector<MeshSamples> meshes_;
    std::vector<TransformTrack> bodies_;

    // The same for all transforms: "follows the parent" and "is one matrix". Bodies that move need
    // as many of these samples as they have matrices, or readers lose the motion.
    AlembicSample inheritsSample_, opsSample_;
    SampleTrack inheritsEveryFrame_, opsEveryFrame_;
};

void AlembicWriter::beginScene(const SceneDescription& scene, int firstFrame, int /*frameCount*/)
{
    scene_ = &scene;
    archive_.emplace(output_);
    everyFrame_ = archive_->addUniformSampling(firstFrame / scene.framesPerSecond,
                                               1.0 / scene.framesPerSecond);
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
    Triangles clockwise = mesh.triangles;
    clockwise.row(1).swap(clockwise.row(2));
    const auto faceCount = static_cast<std::size_t>(clockwise.cols());
    const std::vector<std::int32_t> cornersPerFace(faceCount, 3);

    MeshSamples samples;
    samples.bounds = archive_->writeScalar(bytesOf(bounds));
    samples.points =
        archive_->writeArray(bytesOf(points), static_cast<std::uint64_t>(points.cols()));
    samples.faceIndices = archive_->writeArray(bytesOf(clockwise), 3 * faceCount);
    samples.faceCounts = archive_->writeArray(bytesOf(cornersPerFace), faceCount);
    return samples;
}

void AlembicWriter::writeFrame(const SceneFrame& frame)
{
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
        TransformTrack& track = bodies_[body];
        if (!scene_->bodies[body].moves && track.samples.count() > 0) continue;
        addSample(track, channelsOf(frame.worldFromAsset[body]));
    }
    inheritsEveryFrame_.append(inheritsSample_);
    opsEveryFrame_.append(opsSample_);
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

void AlembicWriter::finishScene()
{
    std::vector<AlembicObject> bodies;
    bodies.reserve(bodies_.size());
    for (std::size_t body = 0; body < bodies_.size(); ++body) {
        bodies.push_back(writeBody(scene_->bodies[body], bodies_[body]));
    }

    TransformTrack axes;
    addSample(axes, scene_->zUp ? kYUpFromZUp : kIdentity);
    const std::array<double, 1> metresPerUnit = {scene_->metresPerUnit};
    const std::string upAxis = zeroTerminated(scene_->zUp ? "z" : "y");
    const std::vector<AlembicProperty> userProperties = {
        archive_->writeConstant(scalarLayout("metresPerUnit", AlembicType::f64),
                                bytesOf(metresPerUnit)),
        archive_->writeConstant(scalarLayout("upAxisOfShot", AlembicType::string), upAxis),
    };
    const AlembicObject root = writeTransform(scene_->name, axes, false, userProperties, bodies);

    // No date: equal input gives equal bytes.
    archive_->finish(
        std::span(&root, 1),
        "_ai_AlembicVersion=layout of Alembic 1.8.12;_ai_Application=Scree;_ai_DCC_FPS=" +
            shortestText(scene_->framesPerSecond));
}

AlembicObject AlembicWriter::writeBody(const SceneBody& body, const TransformTrack& track)
{
    const AlembicObject shape = writeShape(body.name + "Shape", meshes_[body.mesh]);

    std::vector<AlembicProperty> userProperties;
    if (body.mass > 0.0) {
        const std::array<double, 1> mass = {body.mass};
        userProperties.push_back(
            archive_->writeConstant(scalarLayout("mass", AlembicType::f64), bytesOf(mass)));
    }
    if (!body.material.empty()) {
        userProperties.push_back(archive_->writeConstant(
            scalarLayout("material", AlembicType::string), zeroTerminated(body.material)));
    }
    return writeTransform(body.name, track, body.moves, userProperties, std::span(&shape, 1));
}

AlembicObject AlembicWriter::writeShape(const std::string& name, const MeshSamples& mesh)
{
    AlembicLayout bounds = scalarLayout(".selfBnds", AlembicType::f64, 6);
    bounds.metadata = kBoxMetadata;
    AlembicLayout points = arrayLayout("P", AlembicType::f32, 3);
    points.metadata = kPointMetadata;

    const AlembicProperty properties[] = {
        archive_->writeProperty(bounds, SampleTrack(mesh.bounds)),
        archive_->writeProperty(points, SampleTrack(mesh.points)),
        archive_->writeProperty(arrayLayout(".faceIndices", AlembicType::i32),
                                SampleTrack(mesh.faceIndices)),
        archive_->writeProperty(arrayLayout(".faceCounts", AlembicType::i32),
                                SampleTrack(mesh.faceCounts)),
    };
    const AlembicProperty geometry =
        archive_->writeCompound(".geom", std::string(kMeshSchema), properties);
    const std::string metadata = std::string(kMeshSchema) + std::string(kMeshTitle);
    return archive_->writeObject(name, metadata, std::span(&geometry, 1), {});
}

AlembicObject AlembicWriter::writeTransform(const std::string& name, const TransformTrack& track,
                                            bool moves,
                                            const std::vector<AlembicProperty>& userProperties,
                                            std::span<const AlembicObject> children)
{
    const int sampling = moves ? everyFrame_ : 0;
    const SampleTrack& inherits = moves ? inheritsEveryFrame_ : SampleTrack(inheritsSample_);
    const SampleTrack& ops = moves ? opsEveryFrame_ : SampleTrack(opsSample_);

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

    const AlembicProperty transform =
        archive_->writeCompound(".xform", std::string(kXformSchema), properties);
    const std::string metadata = std::string(kXformSchema) + std::string(kXformTitle);
    return archive_->writeObject(name, metadata, std::span(&transform, 1), children);
}

AlembicProperty AlembicWriter::writeMovingChannels(const TransformTrack& track)
{
    std::vector<std::uint32_t> channels;
    for (std::uint32_t k = 0; k < track.first.size(); ++k) {
        if (track.movingChannels >> k & 1u) channels.push_back(k);
    }
    const AlembicSample sample = archive_->writeArray(bytesOf(channels), channels.size());
    return archive_->writeProperty(arrayLayout(".animChans", AlembicType::u32, 1, everyFrame_),
                                   SampleTrack(sample));
}

}  // namespace

std::unique_ptr<FrameWriter> makeAlembicWriter(const fs::path& output)
{
    return std::make_unique<AlembicWriter>(output);
}

}  // namespace scree
