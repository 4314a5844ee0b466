// Symbols: a transform is written M (4×4, for column vectors), its linear part L = R·S with R a
//          rotation and S what scales and shears; S goes into the mesh, R is the pose.
#include "io/alembic_import.h"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <unordered_map>

#include "core/math/rotation.h"
#include "io/alembic_mesh.h"
#include "io/alembic_reader.h"
#include "io/byte_order.h"
#include "io/face_cut.h"

namespace scree {

namespace {

using Mat4 = Eigen::Matrix4d;

constexpr std::uint32_t kMostObjects = 100'000, kMostSamples = 1'000'000;
constexpr double kMostMatrices = 2e7;  // of all transforms of a file; 2.5 GB

constexpr double kSameTime = 1e-5;    // [s], as Alembic itself compares
constexpr double kScaleMoves = 1e-4;  // relative; matrices of others are often single precision
constexpr double kScaleIsOne = 1e-6;
constexpr double kNoSize = 1e-12;

/// A transform over time; one matrix and no times when it never changes.
struct MatrixTrack {
    std::vector<double> seconds;
    std::vector<Mat4> matrices = {Mat4::Identity()};
};

Mat4 turn(const Vec3& axis, double degrees)
{
    Mat4 matrix = Mat4::Identity();
    const double length = axis.norm();
    if (!(length > 0.0)) return matrix;
    double sine = 0.0, cosine = 0.0;
    sinCos(degrees * kPi / 360.0, sine, cosine);
    const Vec3 part = axis * (sine / length);
    matrix.topLeftCorner<3, 3>() = Quat(cosine, part.x(), part.y(), part.z()).toRotationMatrix();
    return matrix;
}

/// Channels that a kind of operation takes; 0 for one that is not known.
int channelCount(int kind)
{
    constexpr int kCounts[] = {3, 3, 4, 16, 1, 1, 1};
    return kind < 7 ? kCounts[kind] : 0;
}

Mat4 operation(int kind, const double* c)
{
    Mat4 matrix = Mat4::Identity();
    switch (kind) {
        case 0:
            matrix.diagonal() << c[0], c[1], c[2], 1.0;
            return matrix;
        case 1:
            matrix.topRightCorner<3, 1>() << c[0], c[1], c[2];
            return matrix;
        case 2:
            return turn({c[0], c[1], c[2]}, c[3]);
        case 3:
            // Theirs stands row by row for row vectors: column by column for ours.
            return Eigen::Map<const Mat4>(c);
        default:
            return turn(Vec3::Unit(kind - 4), c[0]);
    }
}

/// The rotation nearest to L.
Mat3 rotationOf(const Mat3& L)
{
    const Eigen::JacobiSVD<Mat3> svd(L, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Mat3 U = svd.matrixU();
    if ((U * svd.matrixV().transpose()).determinant() < 0.0) U.col(2) = -U.col(2);
    return U * svd.matrixV().transpose();
}

class AlembicImport {
public:
    AlembicImport(const std::string& path, std::uint32_t mostDepth)
        : reader_(path), mostDepth_(mostDepth)
    {
    }

    ImportedFile import()
    {
        visit(reader_.top(), {}, "", 0);
        file_.isYUp = true;  // by custom: no file says
        file_.countsFramesFromZero = true;
        return std::move(file_);
    }

private:
    void visit(const StoredObject& object, const MatrixTrack& fileFromParent,
               const std::string& parentName, std::uint32_t depth)
    {
        if (depth > mostDepth_) {
            reader_.refuse("has objects that are nested deeper than " + std::to_string(mostDepth_) +
                           " (--import-depth)");
        }
        if (++objectCount_ > kMostObjects) {
            reader_.refuse("has more than " + std::to_string(kMostObjects) + " objects");
        }
        if (metadataValue(object.metadata, "isInstance") == "1") {
            StoredObject source = sourceOf(object);
            source.name = object.name;
            return visit(source, fileFromParent, parentName, depth + 1);
        }
        const std::string_view title = metadataValue(object.metadata, "schemaObjTitle");
        if (title.starts_with("AbcGeom_SubD_")) {
            addUnusable(parentName.empty() ? object.name : parentName,
                        "is a subdivision surface; export it as a polygon mesh");
        }
        if (title.starts_with("AbcGeom_PolyMesh_")) {
            addNode(object, fileFromParent, parentName.empty() ? object.name : parentName);
        }
        if (title.starts_with("AbcGeom_Camera_")) {
            addCamera(object, fileFromParent, parentName.empty() ? object.name : parentName);
        }
        const bool isTransform = title.starts_with("AbcGeom_Xform_");
        const MatrixTrack track = isTransform ? placed(object, fileFromParent) : fileFromParent;
        for (const StoredObject& child : reader_.children(object)) {
            visit(child, track, isTransform ? object.name : parentName, depth + 1);
        }
    }

    using Children = std::unordered_map<std::string, StoredObject>;

    StoredObject sourceOf(const StoredObject& instance)
    {
        const auto property = find(reader_.properties(instance), ".instanceSource");
        if (!property) reader_.refuse("is damaged: an instance does not say of what");
        std::string path(reader_.sample(*property, 0));
        path = path.c_str();  // ends with a zero
        StoredObject object = reader_.top();
        for (std::size_t at = 0; at != std::string::npos;) {
            const std::size_t end = path.find('/', at + 1);
            const Children& children = childrenOf(object, path.substr(0, at));
            const auto child = children.find(path.substr(at + 1, end - at - 1));
            if (child == children.end()) {
                reader_.refuse("is damaged: it repeats '" + path + "', which it does not have");
            }
            object = child->second;
            at = end;
        }
        return object;
    }

    /// By their names. Thousands of instances ask for them: they are read once.
    const Children& childrenOf(const StoredObject& object, const std::string& path)
    {
        const auto [known, isNew] = children_.try_emplace(path);
        if (!isNew) return known->second;
        for (StoredObject& child : reader_.children(object)) {
            const std::string name = child.name;
            known->second.try_emplace(name, std::move(child));
        }
        return known->second;
    }

    // ---- transforms

    /// A transform below another.
    MatrixTrack placed(const StoredObject& object, const MatrixTrack& fileFromParent)
    {
        const auto xform = find(reader_.properties(object), ".xform");
        if (!xform) reader_.refuse("is damaged: the transform '" + object.name + "' is empty");
        const std::vector<StoredProperty> properties = reader_.properties(*xform);
        const MatrixTrack own = ownTrack(properties, object.name);
        const auto inherits = find(properties, ".inherits");
        const bool isFree = inherits && inherits->sampleCount > 0 &&
                            reader_.sample(*inherits, 0) == std::string_view("\0", 1);
        if (isFree) return own;

        MatrixTrack track = own.matrices.size() > 1 ? own : fileFromParent;
        const bool bothMove = own.matrices.size() > 1 && fileFromParent.matrices.size() > 1;
        const bool isAsOne = !bothMove || haveSameTimes(own, fileFromParent);
        if (!isAsOne) track.seconds = timesOfBoth(own.seconds, fileFromParent.seconds);
        track.matrices.resize(std::max<std::size_t>(1, track.seconds.size()));
        matrixCount_ += static_cast<double>(track.matrices.size());
        if (matrixCount_ > kMostMatrices) reader_.refuse("holds more motion than can be read");
        for (std::size_t i = 0; i < track.matrices.size(); ++i) {
            track.matrices[i] = isAsOne ? matrixAt(fileFromParent, i) * matrixAt(own, i)
                                        : matrixAtTime(fileFromParent, track.seconds[i]) *
                                              matrixAtTime(own, track.seconds[i]);
        }
        return track;
    }

    static Mat4 matrixAt(const MatrixTrack& track, std::size_t i)
    {
        return track.matrices[std::min(i, track.matrices.size() - 1)];
    }

    static bool haveSameTimes(const MatrixTrack& a, const MatrixTrack& b)
    {
        return std::ranges::equal(a.seconds, b.seconds,
                                  [](double x, double y) { return std::abs(x - y) < kSameTime; });
    }

    static std::vector<double> timesOfBoth(const std::vector<double>& a,
                                           const std::vector<double>& b)
    {
        std::vector<double> times;
        std::ranges::merge(a, b, std::back_inserter(times));
        const auto isSame = [](double x, double y) { return y - x < kSameTime; };
        times.erase(std::unique(times.begin(), times.end(), isSame), times.end());
        return times;
    }

    /// Steadily from sample to sample: place, turn and stretch each for itself. Before the first
    /// and after the last nothing moves.
    static Mat4 matrixAtTime(const MatrixTrack& track, double seconds)
    {
        const auto after = std::ranges::lower_bound(track.seconds, seconds - kSameTime);
        const auto i = static_cast<std::size_t>(after - track.seconds.begin());
        if (after == track.seconds.end()) return track.matrices.back();
        if (i == 0 || *after <= seconds + kSameTime) return track.matrices[i];
        const double share = (seconds - after[-1]) / (*after - after[-1]);
        const Mat4 &A = track.matrices[i - 1], &B = track.matrices[i];
        const Pose a = poseOf(A), b = poseOf(B);
        const auto stretchOf = [](const Pose& pose, const Mat4& M) -> Mat3 {
            return pose.orientation.conjugate().toRotationMatrix() * M.topLeftCorner<3, 3>();
        };
        Mat4 M = Mat4::Identity();
        M.topLeftCorner<3, 3>() = a.orientation.slerp(share, b.orientation).toRotationMatrix() *
                                  ((1.0 - share) * stretchOf(a, A) + share * stretchOf(b, B));
        M.topRightCorner<3, 1>() = (1.0 - share) * a.position + share * b.position;
        return M;
    }

    MatrixTrack ownTrack(const std::vector<StoredProperty>& properties,
                         const std::string& name) const
    {
        const auto ops = find(properties, ".ops"), values = find(properties, ".vals");
        if (!ops || !values || ops->sampleCount == 0 || values->sampleCount == 0) return {};
        if (values->layout.type != AlembicType::f64) reader_.refuse("is damaged: no transform");
        const std::string codes(reader_.sample(*ops, 0));
        const std::uint32_t count = values->firstChange > 0 ? values->sampleCount : 1;
        if (count > kMostSamples) reader_.refuse("has too many samples of '" + name + "'");
        MatrixTrack track;
        track.matrices.clear();
        for (std::uint32_t i = 0; i < count; ++i) {
            track.matrices.push_back(matrixOf(codes, reader_.sample(*values, i), name));
            if (count > 1) track.seconds.push_back(reader_.secondsOf(*values, i));
            if (i > 0 && !(track.seconds[i] > track.seconds[i - 1])) {
                reader_.refuse("is damaged: samples of '" + name + "' are not in order of time");
            }
        }
        return track;
    }

    Mat4 matrixOf(const std::string& codes, std::string_view bytes, const std::string& name) const
    {
        std::vector<double> channels(bytes.size() / sizeof(double));
        // Neither side has an address to copy from or to where there is nothing.
        if (!channels.empty())
            std::memcpy(channels.data(), bytes.data(), sizeof(double) * channels.size());
        Mat4 matrix = Mat4::Identity();
        std::size_t next = 0;
        for (const unsigned char code : codes) {
            const int kind = code >> 4;
            const auto count = static_cast<std::size_t>(channelCount(kind));
            if (count == 0 || next + count > channels.size()) {
                reader_.refuse("is damaged: the transform '" + name + "' lacks numbers");
            }
            matrix = matrix * operation(kind, channels.data() + next);
            next += count;
        }
        if (!matrix.allFinite())
            reader_.refuse("has a transform '" + name + "' that is not finite");
        return matrix;
    }

    // ---- nodes

    void addNode(const StoredObject& object, const MatrixTrack& fileFromMesh,
                 const std::string& name)
    {
        if (isDeforming(reader_, object)) {
            return addUnusable(
                name, "changes its shape over time; only rigid motion can be played: export it so");
        }
        TriMesh mesh;
        try {
            mesh = readAlembicMesh(reader_, object);
        } catch (const UncutFace& face) {
            return addUnusable(name, "has " + face.why);
        }
        if (mesh.triangles.cols() == 0) return;
        ImportedNode node;
        node.name = name;
        const auto shown =
            std::find_if_not(fileFromMesh.matrices.begin(), fileFromMesh.matrices.end(), isHidden);
        const Mat4& M =
            shown == fileFromMesh.matrices.end() ? fileFromMesh.matrices.front() : *shown;
        const Mat3 L = M.topLeftCorner<3, 3>();
        const Mat3 S = rotationOf(L).transpose() * L;
        node.fileFromNode = poseOf(M);
        readKeys(fileFromMesh, S, node);
        if (!S.isApprox(Mat3::Identity(), kScaleIsOne)) mesh.points = S * mesh.points;
        if (S.determinant() < 0.0) turnInsideOut(mesh);
        node.mesh = std::move(mesh);
        file_.nodes.push_back(std::move(node));
    }

    /// What is no rigid body is in nobody's way until it is chosen: the camera of a shot often
    /// stands in one file with its cloth.
    void addUnusable(const std::string& name, const std::string& why)
    {
        ImportedNode node;
        node.name = name;
        node.unusable = why;
        file_.nodes.push_back(std::move(node));
    }

    /// Alembic's cameras look along -z, as ours do.
    void addCamera(const StoredObject& object, const MatrixTrack& fileFromCamera,
                   const std::string& name)
    {
        const auto geom = find(reader_.properties(object), ".geom");
        const auto core = geom ? find(reader_.properties(*geom), ".core") : std::nullopt;
        if (!core || core->sampleCount == 0 || core->layout.type != AlembicType::f64) {
            reader_.refuse("is damaged: the camera '" + object.name + "' has no lens");
        }
        ImportedCamera camera;
        camera.name = name;
        const Lens lens = lensOf(reader_.sample(*core, 0), object.name);
        camera.fovDegrees = fovOf(lens);
        camera.filmAspect = lens.filmWidth / lens.filmHeight;
        camera.lostLens = lostOf(lens);
        const std::uint32_t count = core->firstChange > 0 ? core->sampleCount : 0;
        if (count > kMostSamples) reader_.refuse("has too many samples of '" + name + "'");
        for (std::uint32_t i = 0; i < count; ++i) {
            camera.zoom.push_back(
                {reader_.secondsOf(*core, i), fovOf(lensOf(reader_.sample(*core, i), name))});
        }
        camera.fileFromCamera = poseOf(fileFromCamera.matrices.front());
        for (std::size_t i = 0; i < fileFromCamera.seconds.size(); ++i) {
            camera.keys.push_back({fileFromCamera.seconds[i], poseOf(fileFromCamera.matrices[i])});
        }
        file_.cameras.push_back(std::move(camera));
    }

    /// The numbers of a sample of a lens, as they stand in the file; others follow.
    struct Lens {
        double focalLength = 0.0;                   ///< [mm]
        double filmWidth = 0.0, shiftAcross = 0.0;  ///< [cm]
        double filmHeight = 0.0, shiftUp = 0.0;     ///< [cm]
        double squeeze = 1.0;                       ///< of its picture in width
    };

    Lens lensOf(std::string_view bytes, const std::string& name) const
    {
        Lens lens;
        if (bytes.size() < sizeof lens) {
            reader_.refuse("is damaged: the camera '" + name + "' lacks numbers");
        }
        std::memcpy(&lens, bytes.data(), sizeof lens);
        return lens;
    }

    /// The vertical angle of view of a film.
    static double fovOf(const Lens& lens)
    {
        return 2.0 * std::atan(5.0 * lens.filmHeight / lens.focalLength) * 180.0 / kPi;
    }

    static std::string lostOf(const Lens& lens)
    {
        const bool isShifted = lens.shiftAcross != 0.0 || lens.shiftUp != 0.0;
        const bool isSqueezed = lens.squeeze != 1.0;
        if (!isShifted && !isSqueezed) return "";
        return isShifted && isSqueezed ? "film offset and lens squeeze"
               : isShifted             ? "film offset"
                                       : "lens squeeze";
    }

    static void readKeys(const MatrixTrack& fileFromMesh, const Mat3& S, ImportedNode& node)
    {
        for (std::size_t i = 0; i < fileFromMesh.seconds.size(); ++i) {
            const Mat4& M = fileFromMesh.matrices[i];
            if (isHidden(M)) continue;
            const Pose pose = poseOf(M);
            const Mat3 stretch = pose.orientation.conjugate() * M.topLeftCorner<3, 3>();
            if (!stretch.isApprox(S, kScaleMoves)) {
                node.keys.clear();
                node.obstacle = "its scale changes over time, and bodies are rigid";
                return;
            }
            node.keys.push_back({fileFromMesh.seconds[i], pose});
        }
    }

    /// No size is how many programs, this one too, hide what is not there yet.
    static bool isHidden(const Mat4& M) { return M.topLeftCorner<3, 3>().isZero(kNoSize); }

    static Pose poseOf(const Mat4& M)
    {
        const Mat3 L = M.topLeftCorner<3, 3>();
        return {M.topRightCorner<3, 1>(), Quat(rotationOf(L)).normalized()};
    }

    AlembicReader reader_;
    std::uint32_t mostDepth_;
    ImportedFile file_;
    std::unordered_map<std::string, Children> children_;  // of sources of instances, by path
    std::uint32_t objectCount_ = 0;
    double matrixCount_ = 0.0;
};

}  // namespace

ImportedFile importAlembic(const std::string& path, std::uint32_t mostDepth)
{
    return AlembicImport(path, mostDepth).import();
}

}  // namespace scree
