// The folder of a take: where its parts stand, which of its frames have a file, and who may write.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace scree {

/// Where the parts of a take stand.
struct TakePaths {
    std::filesystem::path root;

    std::filesystem::path info() const { return root / "take.json"; }
    std::filesystem::path stats() const { return root / "stats.jsonl"; }
    std::filesystem::path statsPage() const { return root / "stats.html"; }
    std::filesystem::path checkpoint() const { return root / "checkpoint.scree"; }
    std::filesystem::path lock() const { return root / ".lock"; }
    std::filesystem::path images() const { return root / "images"; }
    std::filesystem::path exports() const { return root / "exports"; }
    std::filesystem::path shapes() const { return root / "shapes"; }
    std::filesystem::path shape(const std::string& name) const
    {
        return shapes() / (name + ".ply");
    }
    std::filesystem::path frames() const { return root / "frames"; }
    std::filesystem::path frame(int frame) const;
};

/// The number in "frame.001001.scree"; nothing for any other name.
std::optional<int> frameNumber(const std::string& name);

/// Numbers of the frame files that stand in the take, whole or not, ascending.
std::vector<int> listFrames(const TakePaths& paths);

/// Whether anything stands there that a take would be known by.
bool holdsTake(const TakePaths& paths);

/// Throws Error{cannotCreate} when `output` is one of the files that the take around it consists
/// of: what is made from a take must not replace it.
void refuseTakeFile(const std::filesystem::path& output);

/// With all folders on the way there, and durable when this returns. Throws Error{cannotCreate} or
/// Error{inputOutput}.
void createFolder(const std::filesystem::path& folder);

/// Held by whoever writes, so that two writers cannot meet. It goes with the process: a killed
/// writer leaves none behind.
class TakeLock {
public:
    /// Throws Error{cannotCreate} when another holds it.
    explicit TakeLock(const TakePaths& paths);
    ~TakeLock();
    TakeLock(const TakeLock&) = delete;
    TakeLock& operator=(const TakeLock&) = delete;

private:
    int descriptor_ = -1;
};

}  // namespace scree
