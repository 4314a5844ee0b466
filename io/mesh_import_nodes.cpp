#include "io/mesh_import_nodes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include <assimp/scene.h>

#include "core/base/error.h"
#include "core/math/rotation.h"
#include "io/face_cut.h"
#include "io/keys_between.h"
#include "io/obj_names.h"
#include "io/text_forms.h"

namespace scree {
namespace {

constexpr std::size_t kMostKeys = 10'000'000;  // of all nodes
constexpr float kScaleMoves = 1e-3f;           // relative; of sampled rotations times scale
constexpr float kRounding = 1e-5f;             // relative; of products of single precision
constexpr float kHiddenScale = 1e-9f;          // far below what anybody draws
constexpr double kSameSeconds = 1e-9;          // ticks and back again

Pose poseOf(const aiQuaternion& q, const aiVector3D& p)
{
    return {Vec3(p.x, p.y, p.z), Quat(q.w, q.x, q.y, q.z)};
}

/// A transform in parts. Of one that shears the rotation is near it, and the rest is no scale.
struct Parts {
    aiVector3D scale, position;
    aiQuaternion rotation;

    explicit Parts(const aiMatrix4x4& transform)
    {
        transform.Decompose(scale, rotation, position);
        rotation.Normalize();  // of what shears it is no unit
    }
    Pose pose() const { return poseOf(rotation, position); }
};

/// What is left of transforms without their rigid parts. Nodes that show one mesh in many places
/// have scales that differ by rounding: with these baked in each would have a shape of its own, so
/// that what differs by no more has the scale that came first.
class Stretches {
public:
    aiMatrix4x4 of(const aiMatrix4x4& transform, const Parts& parts)
    {
        const aiMatrix4x4 rigid(aiVector3D(1.0f), parts.rotation, parts.position);
        const aiMatrix4x4 rest = aiMatrix4x4(rigid).Inverse() * transform;
        const aiVector3D scale(rest.a1, rest.b2, rest.c3);
        const float reach =
            aiVector3D(transform.a4, transform.b4, transform.c4).Length() + scale.Length();
        for (unsigned i = 0; i < 3; ++i) {
            for (unsigned k = 0; k < 3; ++k) {
                if (i != k && std::abs(rest[i][k]) > kRounding * scale.Length()) return rest;
            }
            if (std::abs(rest[i][3]) > kRounding * reach) return rest;
        }
        aiMatrix4x4 stretch;
        return aiMatrix4x4::Scaling(first(scale), stretch);
    }

private:
    aiVector3D first(const aiVector3D& scale)
    {
        for (const aiVector3D& known : known_) {
            if ((known - scale).Length() <= kRounding * known.Length()) return known;
        }
        known_.push_back(scale);
        return scale;
    }

    std::vector<aiVector3D> known_{aiVector3D(1.0f)};
};

/// Whether a scale draws nothing of what is drawn at `rest`: so files hide what is not there yet.
bool isHidden(const aiVector3D& scale, const aiVector3D& rest)
{
    return scale.Length() < 1e-6f * rest.Length();
}

/// The node's transform as an animation has it, in double precision between its keys. What has no
/// size keeps so little that it still shows how it is turned.
class Channel {
public:
    Channel(const aiNodeAnim& keys, double ticksPerSecond, bool scaleJumps)
        : keys_(keys), ticksPerSecond_(ticksPerSecond), scaleJumps_(scaleJumps)
    {
    }

    void addTimes(std::set<double>& seconds) const
    {
        const auto add = [&](const auto* keys, unsigned count) {
            for (unsigned i = 0; i < count; ++i) seconds.insert(keys[i].mTime / ticksPerSecond_);
        };
        add(keys_.mPositionKeys, keys_.mNumPositionKeys);
        add(keys_.mRotationKeys, keys_.mNumRotationKeys);
        add(keys_.mScalingKeys, keys_.mNumScalingKeys);
        // Who pops up or vanishes within a frame or two has no size between; who takes longer
        // grows.
        constexpr double kPopSeconds = 0.1;
        for (unsigned i = 1; i < keys_.mNumScalingKeys && !scaleJumps_; ++i) {
            const double before = keys_.mScalingKeys[i - 1].mTime / ticksPerSecond_;
            const double after = keys_.mScalingKeys[i].mTime / ticksPerSecond_;
            const bool grows = keys_.mScalingKeys[i].mValue != keys_.mScalingKeys[i - 1].mValue;
            if (grows && after - before > kPopSeconds) seconds.insert(0.5 * (before + after));
        }
    }

    /// Whether two of its keys differ.
    bool moves() const
    {
        const auto differ = [](const auto* keys, unsigned count) {
            return std::any_of(keys, keys + count,
                               [&](const auto& key) { return key.mValue != keys->mValue; });
        };
        return differ(keys_.mPositionKeys, keys_.mNumPositionKeys) ||
               differ(keys_.mRotationKeys, keys_.mNumRotationKeys);
    }

    /// Whether it turns or scales what hangs on the node.
    bool turns() const { return keys_.mNumRotationKeys > 1 || keys_.mNumScalingKeys > 1; }

    /// What has no keys stays as the node has it.
    aiMatrix4x4 at(double seconds, const aiMatrix4x4& still) const
    {
        auto [scale, position, rotation] = Parts(still);
        const double ticks = seconds * ticksPerSecond_;
        const auto mix = [](const aiVector3D& a, const aiVector3D& b, float share) {
            return a + share * (b - a);
        };
        const auto turn = [](const aiQuaternion& a, const aiQuaternion& b, float share) {
            aiQuaternion result;
            aiQuaternion::Interpolate(result, a, b, share);
            return result.Normalize();
        };
        between(keys_.mPositionKeys, keys_.mNumPositionKeys, ticks, mix, position);
        between(keys_.mRotationKeys, keys_.mNumRotationKeys, ticks, turn, rotation);
        if (scaleJumps_) {
            hold(keys_.mScalingKeys, keys_.mNumScalingKeys, ticks, scale);
        } else {
            between(keys_.mScalingKeys, keys_.mNumScalingKeys, ticks, mix, scale);
        }
        if (scale.Length() < kHiddenScale) scale = aiVector3D(kHiddenScale);
        // What assimp makes of all three scales along the axes of the parent.
        aiMatrix4x4 stretch;
        return aiMatrix4x4(aiVector3D(1.0f), rotation, position) *
               aiMatrix4x4::Scaling(scale, stretch);
    }

private:
    template <class Key, class Mix, class Value>
    static void between(const Key* keys, unsigned count, double ticks, Mix mix, Value& value)
    {
        if (count == 0) return;
        const Key* end = keys + count;
        const Key* after = std::find_if(keys, end, [&](const Key& k) { return k.mTime >= ticks; });
        if (after == keys || after == end) {
            value = after == end ? end[-1].mValue : keys->mValue;
            return;
        }
        const Key& before = after[-1];
        const double share = (ticks - before.mTime) / (after->mTime - before.mTime);
        value = mix(before.mValue, after->mValue, static_cast<float>(share));
    }

    /// The value of the last key that has come.
    void hold(const aiVectorKey* keys, unsigned count, double ticks, aiVector3D& value) const
    {
        const double now = ticks + kSameSeconds * ticksPerSecond_;
        for (unsigned i = 0; i < count && (i == 0 || keys[i].mTime <= now); ++i) {
            value = keys[i].mValue;
        }
    }

    const aiNodeAnim& keys_;
    double ticksPerSecond_;
    bool scaleJumps_;
};

/// A face as triangles, by the places of their corners in it.
std::vector<int> trianglesOf(const aiMesh& part, const aiFace& polygon)
{
    if (polygon.mNumIndices == 3) return {0, 1, 2};
    Points corners(3, polygon.mNumIndices);
    for (unsigned k = 0; k < polygon.mNumIndices; ++k) {
        if (polygon.mIndices[k] >= part.mNumVertices)
            throw Error(ErrorKind::badInput, "it has a face with a corner that is no point");
        const aiVector3D& p = part.mVertices[polygon.mIndices[k]];
        corners.col(k) << p.x, p.y, p.z;
    }
    return cutFace(corners);
}

/// Fills `mesh` from the given point and face on.
void append(const aiMesh& part, const aiMatrix4x4& nodeFromMesh, TriMesh& mesh, Eigen::Index& point,
            Eigen::Index& face)
{
    // A node that mirrors would turn its triangles inside out.
    const bool isMirrored = nodeFromMesh.Determinant() < 0.0f;
    const Eigen::Index firstPoint = point;
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
        const aiVector3D p = nodeFromMesh * part.mVertices[i];
        // Adding zero turns -0 into +0: the two are one point but not the same bits.
        mesh.points.col(point++) = Vec3(p.x + 0.0, p.y + 0.0, p.z + 0.0);
    }
    const aiVector3D* uvs = part.mTextureCoords[0];
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
        const aiFace& polygon = part.mFaces[i];
        // Loose points and lines have no surface.
        if (polygon.mNumIndices < 3) continue;
        const std::vector<int> cut = trianglesOf(part, polygon);
        for (std::size_t first = 0; first < cut.size(); first += 3, ++face) {
            for (int k = 0; k < 3; ++k) {
                const unsigned corner = polygon.mIndices[cut[first + (isMirrored ? 2 - k : k)]];
                mesh.triangles(k, face) = static_cast<int>(firstPoint + corner);
                if (uvs) mesh.cornerUvs.col(3 * face + k) << uvs[corner].x, uvs[corner].y;
            }
        }
    }
}

Eigen::Index triangleCount(const aiMesh& part)
{
    Eigen::Index count = 0;
    for (unsigned i = 0; i < part.mNumFaces; ++i)
        count +=
            std::max(static_cast<Eigen::Index>(part.mFaces[i].mNumIndices) - 2, Eigen::Index{0});
    return count;
}

/// What a node shows, as one mesh in its axes.
TriMesh meshOf(const aiScene& scene, const aiNode& node, const aiMatrix4x4& nodeFromMesh)
{
    Eigen::Index points = 0, faces = 0;
    bool hasUvs = false;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        const aiMesh& part = *scene.mMeshes[node.mMeshes[i]];
        points += part.mNumVertices;
        faces += triangleCount(part);
        hasUvs = hasUvs || part.mTextureCoords[0] != nullptr;
    }
    TriMesh mesh{Points(3, points), Triangles(3, faces)};
    if (hasUvs) mesh.cornerUvs = CornerUvs::Zero(2, 3 * faces);
    points = faces = 0;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        append(*scene.mMeshes[node.mMeshes[i]], nodeFromMesh, mesh, points, faces);
    }
    mesh.triangles.conservativeResize(3, faces);
    if (hasUvs) mesh.cornerUvs.conservativeResize(2, 3 * faces);
    return mesh;
}

/// Whether bones or morph targets bend what a node shows.
bool isBent(const aiScene& scene, const aiNode& node)
{
    return std::any_of(node.mMeshes, node.mMeshes + node.mNumMeshes, [&](unsigned m) {
        return scene.mMeshes[m]->mNumBones > 0 || scene.mMeshes[m]->mNumAnimMeshes > 0;
    });
}

/// How a camera looks in the axes of its node, where it stands at the origin. (mPosition
/// repeats the translation of a glTF's node.)
Pose poseInNode(const aiCamera& camera)
{
    const auto toVec3 = [](const aiVector3D& v) { return Vec3(v.x, v.y, v.z); };
    const Vec3 back = -toVec3(camera.mLookAt).normalized();
    const Vec3 right = toVec3(camera.mUp).cross(back).normalized();
    if (!back.allFinite() || !right.allFinite()) {
        throw Error(ErrorKind::badInput, "a camera of it looks nowhere");
    }
    Mat3 axes;
    axes << right, back.cross(right), back;
    return {Vec3::Zero(), Quat(axes).normalized()};
}

/// Walks the tree of a file. Meshes come out in the axes of their node with its scale baked.
class NodeReader {
public:
    NodeReader(const aiScene& scene, const GltfReading* gltf, const FbxLens* fbx,
               std::uint32_t mostDepth)
        : scene_(scene), mostDepth_(mostDepth), gltf_(gltf), fbx_(fbx)
    {
        for (unsigned a = 0; a < scene.mNumAnimations; ++a) {
            const aiAnimation& animation = *scene.mAnimations[a];
            const double rate = animation.mTicksPerSecond > 0.0 ? animation.mTicksPerSecond : 1.0;
            for (unsigned c = 0; c < animation.mNumChannels; ++c) {
                const aiNodeAnim& keys = *animation.mChannels[c];
                const std::string name = keys.mNodeName.C_Str();
                channels_.try_emplace(name, keys, rate, gltf && gltf->jumpingScales.contains(name));
                clipsOf_[name].insert(a);
            }
        }
        countNames(*scene.mRootNode, 0);
        for (unsigned c = 0; c < scene.mNumCameras; ++c) {
            cameraOfNode_.try_emplace(scene.mCameras[c]->mName.C_Str(), scene.mCameras[c]);
        }
    }

    void visit(const aiNode& node)
    {
        if (chain_.size() > mostDepth_) {
            throw Error(ErrorKind::badInput, "its nodes are nested deeper than " +
                                                 std::to_string(mostDepth_) + " (--import-depth)");
        }
        chain_.push_back(&node);
        if (node.mNumMeshes > 0) read(node);
        const auto camera = cameraOfNode_.find(node.mName.C_Str());
        if (camera != cameraOfNode_.end()) read(*camera->second);
        for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i]);
        chain_.pop_back();
    }

    std::vector<ImportedNode> takeNodes() { return std::move(nodes_); }
    std::vector<ImportedCamera> takeCameras() { return std::move(cameras_); }

private:
    /// Assimp tells nodes apart by their names alone.
    void countNames(const aiNode& node, std::uint32_t depth)
    {
        if (depth > mostDepth_) return;  // visit() says so
        ++namesakes_[node.mName.C_Str()];
        for (unsigned i = 0; i < node.mNumChildren; ++i) countNames(*node.mChildren[i], depth + 1);
    }

    const Channel* channelOf(const aiNode& node) const
    {
        const auto channel = channels_.find(node.mName.C_Str());
        return channel == channels_.end() ? nullptr : &channel->second;
    }

    /// Why the animation of the node or of one above it may mean another; empty when it may not.
    std::string doubt() const
    {
        for (const aiNode* link : chain_) {
            const std::string name = link->mName.C_Str();
            if (!channelOf(*link) || namesakes_.at(name) < 2) continue;
            return "several nodes are called '" + name +
                   "', and which of them its animation moves cannot be told: name them apart";
        }
        return "";
    }

    void read(const aiNode& node)
    {
        // Split the transform into what is rigid and the rest, which goes into the mesh.
        const aiMatrix4x4 fileFromNode = chainAtRest();
        const Parts parts(fileFromNode);

        ImportedNode result;
        result.name = openedObjName(node.mName.C_Str());
        if (parts.scale.x == 0.0f || parts.scale.y == 0.0f || parts.scale.z == 0.0f) {
            result.unusable =
                "is scaled to nothing where the file is at rest: export it from a "
                "frame in which it is visible";
            nodes_.push_back(std::move(result));
            return;
        }
        try {
            result.mesh = meshOf(scene_, node, stretches_.of(fileFromNode, parts));
        } catch (const UncutFace& face) {
            result.unusable = "has " + face.why;
            nodes_.push_back(std::move(result));
            return;
        }
        if (result.mesh.triangles.cols() == 0) return;
        result.fileFromNode = parts.pose();
        result.isBent = isBent(scene_, node);
        readKeys(parts.scale, result);
        if (!result.keys.empty()) {
            result.lostJoin = lostJoin();
            result.lostClips = lostClips();
        }
        nodes_.push_back(std::move(result));
    }

    void read(const aiCamera& camera)
    {
        if (const std::string why = doubt(); !why.empty()) throw Error(ErrorKind::badInput, why);
        ImportedCamera result;
        result.name = camera.mName.C_Str();
        readAngle(camera, result);
        const Pose nodeFromCamera = poseInNode(camera);
        const auto fileFromCamera = [&](const aiMatrix4x4& fileFromNode) {
            return Parts(fileFromNode).pose() * nodeFromCamera;
        };
        result.fileFromCamera = fileFromCamera(chainAtRest());
        result.keys = keysOf([&](double time) { return fileFromCamera(chainAt(time)); });
        result.lostJoin = lostJoin();
        result.lostClips = lostClips();
        cameras_.push_back(std::move(result));
    }

    /// assimp keeps a horizontal angle: of FBX the file's own, of glTF the vertical one times the
    /// aspect, which is 1 where the file names none.
    /// Where FBX has no angle it says 1 degree; programs write a film and a focal length instead.
    void readAngle(const aiCamera& camera, ImportedCamera& result) const
    {
        const double aspect = camera.mAspect > 0.0f ? camera.mAspect : 1.0;
        double tangent = std::tan(0.5 * camera.mHorizontalFOV);
        constexpr double kNone = kPi / 180.0;
        if (fbx_ && !fbx_->hasOneDegree && std::abs(camera.mHorizontalFOV - kNone) < 1e-6) {
            if (!fbx_->halfTangent) {
                result.unusable =
                    "has no angle of view, nor a film and focal length that it would follow from: "
                    "export it with 'FieldOfView'";
                return;
            }
            tangent = *fbx_->halfTangent;
        }
        const double angle =
            gltf_ ? camera.mHorizontalFOV / aspect : 2.0 * std::atan(tangent / aspect);
        result.fovDegrees = angle * 180.0 / kPi;
    }

    /// When the node or one above it has a key.
    std::set<double> keyTimes()
    {
        std::set<double> seconds;
        for (const aiNode* link : chain_) {
            if (const Channel* channel = channelOf(*link)) channel->addTimes(seconds);
        }
        count(seconds.size());
        return seconds;
    }

    void count(std::size_t keys)
    {
        keyCount_ += keys;
        if (keyCount_ > kMostKeys) throw Error(ErrorKind::badInput, "it has too many keys");
    }

    /// Whether the node can leave the straight way from key to key: what it hangs on turns.
    bool isSwungRound() const
    {
        return std::any_of(chain_.begin(), chain_.end() - 1, [&](const aiNode* link) {
            const Channel* channel = channelOf(*link);
            return channel && channel->turns();
        });
    }

    std::vector<ImportedKey> keysOf(const std::function<Pose(double)>& poseAt)
    {
        const std::set<double> moments = keyTimes();
        std::vector<ImportedKey> keys;
        if (!isSwungRound()) {
            for (const double moment : moments) keys.push_back({moment, poseAt(moment)});
            return keys;
        }
        keys = keysAlong(moments, poseAt);
        count(keys.size() - moments.size());
        return keys;
    }

    /// How the file joins the samples of what moves the node, if not straight.
    std::string lostJoin() const
    {
        for (const aiNode* link : chain_) {
            const Channel* channel = channelOf(*link);
            if (!gltf_ || !channel || !channel->moves()) continue;
            const auto join = gltf_->joins.find(link->mName.C_Str());
            if (join == gltf_->joins.end()) continue;
            return join->second == SampleJoin::jump ? "jumps (STEP)" : "curves (CUBICSPLINE)";
        }
        return "";
    }

    std::string nameOfClip(unsigned clip) const
    {
        constexpr std::size_t kLongestShown = 60;
        const std::string name = shortened(scene_.mAnimations[clip]->mName.C_Str(), kLongestShown);
        return name.empty() ? "number " + std::to_string(clip + 1) : "'" + name + "'";
    }

    /// What is said of the clips that move the node, if there are several: programs write one for
    /// each of its actions. It plays the first that has a channel for it.
    std::string lostClips() const
    {
        for (const aiNode* link : chain_) {
            const auto clips = clipsOf_.find(link->mName.C_Str());
            if (clips == clipsOf_.end() || clips->second.size() < 2) continue;
            const unsigned played = *clips->second.begin(),
                           lost = *std::next(clips->second.begin());
            const std::size_t more = clips->second.size() - 2;
            return nameOfClip(played) + " is played, and not " + nameOfClip(lost) +
                   (more > 0 ? " or " + std::to_string(more) + " more" : "");
        }
        return "";
    }

    void readKeys(const aiVector3D& scale, ImportedNode& result)
    {
        result.obstacle = doubt();
        if (!result.obstacle.empty()) return;
        bool keepsScale = true;
        std::set<double> hidden;  // until it is seen it waits where it will appear
        result.keys = keysOf([&](double time) {
            const Parts now(chainAt(time));
            if (isHidden(now.scale, scale)) hidden.insert(time);
            const float change = (now.scale - scale).Length();
            keepsScale = keepsScale &&
                         (isHidden(now.scale, scale) || change <= kScaleMoves * scale.Length());
            return now.pose();
        });
        std::erase_if(result.keys,
                      [&](const ImportedKey& key) { return hidden.contains(key.seconds); });
        if (keepsScale) return;
        result.keys.clear();
        result.obstacle = "its scale changes over time, and bodies are rigid";
    }

    /// The file's axes from those of the node that is visited, without and with its animation.
    aiMatrix4x4 chainAtRest() const
    {
        aiMatrix4x4 result;
        for (const aiNode* link : chain_) result = result * link->mTransformation;
        return result;
    }

    aiMatrix4x4 chainAt(double seconds) const
    {
        aiMatrix4x4 result;
        for (const aiNode* link : chain_) {
            const Channel* channel = channelOf(*link);
            result = result * (channel ? channel->at(seconds, link->mTransformation)
                                       : link->mTransformation);
        }
        return result;
    }

    const aiScene& scene_;
    std::uint32_t mostDepth_;
    const GltfReading* gltf_;                            // null of other files
    const FbxLens* fbx_;                                 // likewise
    std::map<std::string, Channel> channels_;            // by the name of their node
    std::map<std::string, std::set<unsigned>> clipsOf_;  // likewise, in the order of the file
    Stretches stretches_;
    std::map<std::string, int> namesakes_;  // how many nodes have a name
    std::vector<const aiNode*> chain_;      // from the root to the node that is visited
    std::map<std::string, const aiCamera*> cameraOfNode_;
    std::vector<ImportedNode> nodes_;
    std::vector<ImportedCamera> cameras_;
    std::size_t keyCount_ = 0;
};

}  // namespace

void readNodes(const aiScene& scene, const GltfReading* gltf, const FbxLens* fbx,
               std::uint32_t mostDepth, ImportedFile& file)
{
    NodeReader reader(scene, gltf, fbx, mostDepth);
    reader.visit(*scene.mRootNode);
    file.nodes = reader.takeNodes();
    file.cameras = reader.takeCameras();
}

}  // namespace scree
