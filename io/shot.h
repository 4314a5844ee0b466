// A shot as plain data: what the shot file says, with lengths turned into metres, angles into
// radians and names checked, but nothing built yet. Every item remembers where in the file it
// stands.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/dynamics/settings.h"
#include "core/geometry/shape.h"
#include "core/math/types.h"
#include "core/picture/scene_description.h"
#include "core/scene/body.h"
#include "core/scene/force_field.h"
#include "core/scene/motion_script.h"
#include "io/import_limits.h"

namespace scree {

/// Generated shapes; fields as in core/geometry/primitives.h, lengths [m].
struct TorusSpec {
    double major = 1.0, minor = 0.25;
    std::array<int, 2> segments = {16, 10};
};
struct BoxSpec {
    Vec3 size = Vec3::Ones();
    std::array<int, 3> segments = {2, 2, 2};
};
struct SphereSpec {
    double radius = 0.5;
    int subdivisions = 3;
};
struct CylinderSpec {
    double radius = 0.5, height = 1.0;
    int sectors = 20, bands = 1;
};
struct CapsuleSpec {
    double radius = 0.25, height = 1.0;
    int sectors = 20, rings = 5;
};
/// An asset on disk; `path` is absolute or relative to the working directory, ready to open.
struct FileSpec {
    std::string path;
};

/// What a node of an imported file shows; read once, however many nodes show the same.
struct NodeSpec {
    std::string path;
    std::shared_ptr<const TriMesh> mesh;  ///< [m]
};

using ShapeSource =
    std::variant<TorusSpec, BoxSpec, SphereSpec, CylinderSpec, CapsuleSpec, FileSpec, NodeSpec>;

struct ShotShape {
    std::string name;
    ShapeSource source;
    Vec3 scale = Vec3::Ones();  ///< baked into the mesh
    ShapeSettings settings;     ///< of its field, normals and samples; voxel [m]
    bool isExact = false;       ///< collides as the formula; of spheres, boxes and cylinders only
    std::optional<FileSpec> collision;  ///< collides as this mesh; `source` is only drawn
    SourceLocation location;
};

/// Material plus how it looks.
struct ShotMaterial {
    Material material;
    Vec3 color = {0.6, 0.6, 0.6};  ///< linear
    double roughness = 0.5;
    SourceLocation location;
};

/// Infinite half space below a plane; shape of a static body.
struct PlaneSpec {
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::UnitY();
};

/// When an emitted body comes, and what happens while its place is taken.
struct ShotBirth {
    int frame = 1001;  ///< the earliest
    BirthClearance clearance = BirthClearance::wait;
};

/// One body of the finished shot: grids, pose files and emitters are already expanded.
struct ShotBody {
    std::string name;
    std::string item;  ///< name of the [[body]] or [[emitter]] it comes from; empty: an [[import]]
    std::optional<std::string> shape;  ///< a shape's name; exactly one of shape and plane is set
    std::optional<PlaneSpec> plane;
    std::string material;
    BodyKind kind = BodyKind::dynamic;
    Pose worldFromAsset;                  ///< [m]
    Vec3 velocity = Vec3::Zero();         ///< [m/s]
    Vec3 angularVelocity = Vec3::Zero();  ///< world axes [rad/s]
    std::optional<double> mass;           ///< [kg]
    Vec3 force = Vec3::Zero();            ///< [N]
    Vec3 torque = Vec3::Zero();           ///< [N m]
    CollisionGroups groups;
    bool startsAsleep = false;    ///< rests until something touches it
    bool isVisible = true;        ///< false: collides, and is left out of pictures
    std::vector<MotionKey> keys;  ///< of a keyed body; times since the first frame [s], poses [m]
    KeyInterpolation interpolation = KeyInterpolation::smooth;
    std::optional<int> keyedFromFrame;  ///< until which a keyed body is dynamic
    std::optional<int> releaseFrame;    ///< at which a keyed body becomes dynamic
    std::optional<ShotBirth> birth;     ///< without: there from the start
    SourceLocation location;

    /// Whether forces and impulses never move it.
    bool isNeverFree() const
    {
        return kind == BodyKind::fixed ||
               (kind == BodyKind::keyed && !keyedFromFrame && !releaseFrame);
    }
};

/// Two materials against each other, a ≤ b.
struct ShotPair {
    std::string a, b;
    std::optional<double> friction, restitution;
};

/// What to do with bodies that overlap before anything has moved.
enum class StartOverlapRule {
    error,     ///< refuse to simulate
    warn,      ///< say so and begin
    separate,  ///< push them apart first
};

struct ShotRender {
    std::array<int, 2> size = {1280, 720};
    bool burnIn = true;  ///< figures written into the pictures
    int motionBlur = 1;  ///< moments a picture is the mean of
};

struct ShotOutput {
    std::vector<std::string>
        exports;  ///< file name endings written when the simulation ends: "abc", …
    std::vector<double> subframes;  ///< samples around every frame [frames], see io/subframes.h
    bool contacts = false;          ///< whether frames keep what their last step did
};

struct Shot {
    std::string name;
    int firstFrame = 1001;  ///< simulated time zero
    int lastFrame = 1240;
    double framesPerSecond = 24.0;
    double metresPerUnit = 1.0;
    bool zUp = false;
    StepSettings settings;  ///< gravity and seed included
    double penetrationWarn = 0.01,
           penetrationFail = 0.1;  ///< of the smaller body's longest box edge
    StartOverlapRule startOverlap = StartOverlapRule::error;  ///< beyond penetrationWarn
    std::vector<ShotMaterial> materials;
    std::vector<ShotShape> shapes;
    std::vector<ShotBody> bodies;
    std::vector<ForceField> fields;  ///< SI
    std::vector<ShotPair> pairs;
    std::vector<SceneCamera> cameras;  ///< lengths [m]
    ShotRender render;
    ShotOutput output;
    std::vector<std::string> sideFiles;  ///< it was read from, beside the assets of its shapes
    ImportLimits importLimits;  ///< of the assets it names; the caller's, no file may raise them
    std::vector<std::string> warnings;  ///< "file:line:column: message", of what is passed over
    std::string resolvedText;  ///< canonical TOML of everything, defaults included, --set applied
};

}  // namespace scree
