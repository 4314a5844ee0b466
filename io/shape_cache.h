// Distance fields and repaired solids kept on disk between runs, so that a shot whose shapes were
// seen before starts at once. One file to each, named by the hash of all that it is made from.
//
// A cache may be deleted at any time and is never the only copy of anything. What is read has its
// checksum tested; a damaged file counts as absent and is written anew. That something cannot be
// kept (no room, no permission) is no reason to stop a run: it is only told.
#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "core/geometry/shape_store.h"

namespace scree {

/// Finds and keeps for several threads at a time; the rest is asked when they are done.
class ShapeCache : public ShapeStore {
public:
    /// The folder is made when something is first kept. An empty name: nothing is ever there.
    explicit ShapeCache(std::filesystem::path folder);

    std::optional<DistanceField> findField(std::uint64_t key) override;
    void keepField(std::uint64_t key, const DistanceField& field) override;
    std::optional<TriMesh> findSolid(std::uint64_t key) override;
    void keepSolid(std::uint64_t key, const TriMesh& solid) override;

    const std::filesystem::path& folder() const { return folder_; }
    int foundCount() const { return found_; }
    int keptCount() const { return kept_; }
    /// Why something could not be read or kept, the last time; empty when all went well.
    const std::string& problem() const { return problem_; }

    struct Size {
        int files = 0;
        std::uint64_t bytes = 0;
    };
    /// What lies in the folder now.
    Size size() const;

private:
    template <class What>
    std::optional<What> find(const std::filesystem::path& file, std::uint64_t key,
                             std::optional<What> (*read)(std::uint64_t, std::string_view));
    void keep(const std::filesystem::path& file, const std::string& bytes);
    void tidyOnce();

    std::filesystem::path folder_;
    std::mutex lock_;  // of what follows
    bool isTidy_ = false;
    int found_ = 0, kept_ = 0;
    std::string problem_;
};

/// $XDG_CACHE_HOME/scree, else ~/.cache/scree; empty where neither variable names a folder.
std::filesystem::path defaultCacheFolder();

}  // namespace scree
