#include "tools/settled_poses.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include "core/base/error.h"
#include "io/pose_file.h"

namespace scree {
namespace {

/// Copies of one item that show one shape.
struct Copies {
    std::string item, shape;
    std::vector<Pose> poses;  ///< of those that are born, in the order of their numbers
};

/// Of all that is free at some time, born or not: names must not depend on how far a run came.
/// `poseOf` gives the pose of a body by its index, or nothing.
template <class PoseOf>
std::vector<Copies> copiesOf(const Shot& shot, const PoseOf& poseOf)
{
    std::vector<Copies> all;
    for (std::size_t i = 0; i < shot.bodies.size(); ++i) {
        const ShotBody& body = shot.bodies[i];
        if (body.isNeverFree()) continue;
        const std::string shape = body.shape.value_or("");
        const auto isTheirs = [&](const Copies& copies) {
            return copies.item == body.item && copies.shape == shape;
        };
        auto copies = std::ranges::find_if(all, isTheirs);
        if (copies == all.end()) copies = all.insert(copies, {body.item, shape, {}});
        if (const std::optional<Pose> pose = poseOf(i)) copies->poses.push_back(*pose);
    }
    return all;
}

std::string pathFor(const Copies& copies, const std::vector<Copies>& all, const std::string& output)
{
    if (all.size() == 1) return output;
    const auto isSibling = [&](const Copies& other) { return other.item == copies.item; };
    const bool hasSeveralShapes = std::ranges::count_if(all, isSibling) > 1;
    std::filesystem::path path = output;
    path.replace_filename(path.stem().string() + "_" + copies.item +
                          (hasSeveralShapes ? "_" + copies.shape : "") + path.extension().string());
    return path.string();
}

/// Shape "b" of "a" and all of "a_b" would have one name.
void requireOwnNames(const std::vector<Copies>& all, const std::string& output)
{
    std::map<std::string, const Copies*> owners;
    for (const Copies& copies : all) {
        const std::string path = pathFor(copies, all, output);
        const auto [owner, isNew] = owners.try_emplace(path, &copies);
        if (isNew) continue;
        const Copies& other = *owner->second;
        throw Error(ErrorKind::usage, "cannot write '" + output + "': shape '" + other.shape +
                                          "' of '" + other.item + "' and shape '" + copies.shape +
                                          "' of '" + copies.item + "' would both be '" + path +
                                          "'; give one of them another name");
    }
}

}  // namespace

void requirePosableBodies(const Shot& shot, const std::string& output)
{
    bool anyMoves = false;
    for (const ShotBody& body : shot.bodies) {
        if (body.isNeverFree()) continue;
        anyMoves = true;
        if (!body.item.empty()) continue;
        throw Error(ErrorKind::usage,
                    "cannot write '" + output +
                        "': a .poses file holds copies of a [[body]], and '" + body.name +
                        "' is a node of the [[import]] at " + toString(body.location) +
                        ", with a shape of its own; .abc, .glb and .json hold any body");
    }
    if (!anyMoves)
        throw Error(ErrorKind::usage,
                    "cannot write '" + output + "': all of the shot is static or keyed");
    requireOwnNames(copiesOf(shot, [](std::size_t) { return std::optional<Pose>(); }), output);
}

std::vector<PosesFile> settledPoses(const Shot& shot, const World& world, const SceneFrame& frame,
                                    const std::string& output)
{
    std::vector<PosesFile> files;
    const std::vector<Copies> all = copiesOf(shot, [&](std::size_t i) {
        return world.isBorn(static_cast<BodyId>(i)) ? std::optional(frame.worldFromAsset[i])
                                                    : std::nullopt;
    });
    for (const Copies& copies : all) {
        if (copies.poses.empty()) continue;
        const std::string count = std::to_string(copies.poses.size());
        files.push_back({pathFor(copies, all, output),
                         encodePoseFile(copies.poses, count + " of '" + copies.item + "', shape '" +
                                                          copies.shape + "', settled in shot '" +
                                                          shot.name + "'")});
    }
    return files;
}

}  // namespace scree
