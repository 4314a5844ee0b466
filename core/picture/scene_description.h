// What those who show or store a scene need of it: names, meshes as the artist made them, and poses
// of the artist's own frames, looks and cameras. It is the one language that simulation, writers
// and pictures share.
//
// Lengths are in the shot's unit of length, axes are the shot's axes.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/math/types.h"

namespace scree {

/// A mesh in the artist's frame, shared by many bodies.
struct SceneMesh {
    std::string name;
    Points points;             // 3×#V
    Triangles triangles;       // 3×#F
    CornerUvs cornerUvs = {};  // 2×(3·#F), or empty
    bool isPlane = false;      // a square that stands for one without end
};

/// Birth frames of bodies that are always there, and of those that never come.
inline constexpr int kFromTheStart = std::numeric_limits<int>::min();
inline constexpr int kNeverBorn = std::numeric_limits<int>::max();

struct SceneBody {
    std::string name;                ///< identifier, unique in the scene
    std::size_t mesh = 0;            ///< index into SceneDescription::meshes
    std::string material;            ///< name of its material
    double mass = 0.0;               ///< [kg], 0 for bodies that cannot be moved
    bool moves = true;               ///< false: the pose of the first frame holds for all
    int birthFrame = kFromTheStart;  ///< the first frame in which it exists
    bool isVisible = true;           ///< false: others collide with it and nobody sees it
};

/// The first frame in which it is to be seen.
inline int seenFrom(const SceneBody& body)
{
    return body.isVisible ? body.birthFrame : kNeverBorn;
}

inline bool isSeen(const SceneBody& body, int frame)
{
    return frame >= seenFrom(body);
}

/// How a material behaves and looks, for formats that can hold it.
struct SceneMaterial {
    std::string name;
    Vec3 color = {0.6, 0.6, 0.6};  ///< linear
    double roughness = 0.5;
    double density = 0.0;  ///< [kg/m³]
    double friction = 0.0, restitution = 0.0;
};

/// Where a keyed camera is at one moment.
struct CameraKey {
    double frame = 1001.0;
    Vec3 eye = Vec3::Zero(), target = Vec3::Zero();
    double fovDegrees = 35.0;  ///< vertical
    Vec3 up = Vec3::Zero();    ///< as SceneCamera::up
};

/// Part of a circle around the up axis, at even speed, always looking at its centre.
struct CameraOrbit {
    Vec3 centre = Vec3::Zero();
    double radius = 1.0, height = 0.0;           ///< of the eye from and above the centre
    double startDegrees = 0.0, degrees = 360.0;  ///< where it begins, and how far it goes
    double firstFrame = 1001.0, lastFrame = 1240.0;
};

/// Stands still, or has keys, or an orbit; camera_motion.h tells where it is then.
struct SceneCamera {
    std::string name = "main";
    Vec3 eye = Vec3::Zero(), target = Vec3::Zero();
    double fovDegrees = 35.0;  ///< vertical
    /// Which way is up in the picture; need not be at right angles, zero: as in the scene. Cameras
    /// of files have one, since they may be rolled or look straight down.
    Vec3 up = Vec3::Zero();
    std::vector<CameraKey> keys = {};  ///< frames ascending
    bool isSmooth = true;  ///< passes its keys without a kink; else straight on to the next
    std::optional<CameraOrbit> orbit = {};
};

struct SceneDescription {
    std::string name;  ///< identifier; top-level object of every export
    double framesPerSecond = 24.0;
    double metresPerUnit = 1.0;  ///< length of one unit [m]
    bool zUp = false;            ///< the shot's up axis is z instead of y
    std::vector<SceneMesh> meshes;
    std::vector<SceneBody> bodies;
    std::vector<SceneMaterial> materials;  ///< those that bodies name, if known
    std::vector<SceneCamera> cameras;
    double aspect = 16.0 / 9.0;  ///< width over height of the picture
};

/// One sample of the motion: everything parallel to SceneDescription::bodies.
struct SceneFrame {
    int frame = 1001;
    double offset = 0.0;  ///< [frames] after `frame`; 0 is the frame itself
    std::vector<Pose> worldFromAsset;
    std::vector<Vec3> velocity;         ///< of the asset's origin, units per second
    std::vector<Vec3> angularVelocity;  ///< world axes [rad/s]
};

}  // namespace scree
