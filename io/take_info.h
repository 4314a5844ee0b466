// What take.json says: which shot a take was made from, by which program, and what is in it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/picture/scene_description.h"
#include "core/scene/world.h"
#include "io/shot.h"

namespace scree {

inline constexpr const char* kTakeFormat = "scree take";
inline constexpr int kTakeFormatVersion = 1;

/// A file that the shot was built from; the hash tells whether it has changed since.
struct TakeInput {
    std::string path;
    std::uint64_t hash = 0;
};

/// A mesh kept under shapes/.
struct TakeShape {
    std::string name;
    std::uint64_t hash = 0;  ///< of the file's bytes
};

struct TakeBody {
    std::string name;
    std::string shape;     ///< name of its mesh
    bool isPlane = false;  ///< infinite, through its asset's origin with normal +y; no mesh is kept
    std::string material;
    BodyKind kind = BodyKind::dynamic;
    double mass = 0.0;      ///< [kg], 0 for bodies that cannot be moved
    bool isVisible = true;  ///< false: left out of pictures, hidden in what is exported
};

struct TakeInfo {
    std::string programVersion;
    std::string name;
    std::string resolvedShot;    ///< canonical text of the shot, defaults included
    std::uint64_t shotHash = 0;  ///< of that text
    std::uint64_t seed = 0;
    double framesPerSecond = 24.0;
    double metresPerUnit = 1.0;
    bool zUp = false;
    int firstFrame = 1001;
    int lastFrame = 1240;
    std::string branchTake;  ///< whose frames up to branchFrame this take begins with; or empty
    int branchFrame = 0;
    /// Of the bytes of that frame as they stand in this take; 0 in takes older than this key.
    std::uint64_t branchHash = 0;
    std::vector<TakeInput> inputs;
    std::vector<TakeShape> shapes;
    std::vector<TakeBody> bodies;
    std::vector<SceneMaterial> materials;
    std::vector<SceneCamera> cameras;
    std::array<int, 2> pictureSize = {1280, 720};
    bool burnIn = true;                   ///< figures written into the pictures
    int motionBlur = 1;                   ///< moments a picture is the mean of
    std::vector<double> offsets = {0.0};  ///< of the samples around every frame (io/subframes.h)
    bool hasContacts = false;             ///< frames hold what their last step did
};

/// Everything but the hashes of the shapes, which exist once they are written. `scene` is what
/// describeScene says of shot and world.
TakeInfo makeTakeInfo(const Shot& shot, const World& world, const SceneDescription& scene,
                      const std::string& programVersion);

/// The text of take.json.
std::string encodeTakeInfo(const TakeInfo& info);

/// Whether it is JSON at all, as what was cut or overwritten is not.
bool isJson(const std::string& text);

/// Throws Error{inputOutput} naming `path` when the text is damaged or of an unknown version.
TakeInfo decodeTakeInfo(const std::string& text, const std::filesystem::path& path);

}  // namespace scree
