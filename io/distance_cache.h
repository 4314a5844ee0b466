// Distance fields kept on disk between runs, so that a shot whose shapes were seen before starts at
// once. One file to a field, named by the hash of all that it is built from.
//
// A cache may be deleted at any time and is never the only copy of anything. What is read has its
// checksum tested; a damaged file counts as absent and is written anew. That a field cannot be kept
// (no room, no permission) is no reason to stop a run: it is only told.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/geometry/field_store.h"

namespace scree {

class DistanceCache : public FieldStore {
public:
    /// The folder is made when something is first kept. An empty name: nothing is ever there.
    explicit DistanceCache(std::filesystem::path folder);

    std::optional<DistanceField> find(std::uint64_t key) override;
    void keep(std::uint64_t key, const DistanceField& field) override;

    const std::filesystem::path& folder() const { return folder_; }
    std::filesystem::path fileOf(std::uint64_t key) const;
    int foundCount() const { return found_; }
    int keptCount() const { return kept_; }
    /// Why the last field could not be read or kept; empty when all went well.
    const std::string& problem() const { return problem_; }

    struct Size {
        int files = 0;
        std::uint64_t bytes = 0;
    };
    /// What lies in the folder now.
    Size size() const;

private:
    std::filesystem::path folder_;
    int found_ = 0, kept_ = 0;
    std::string problem_;
};

/// $XDG_CACHE_HOME/scree, else ~/.cache/scree; empty where neither variable names a folder.
std::filesystem::path defaultCacheFolder();

/// A field as bytes: equal fields give equal bytes.
std::string bytesOfField(std::uint64_t key, const DistanceField& field);

/// Nothing when the bytes are not whole, not of this key or not written by this version.
std::optional<DistanceField> fieldOfBytes(std::uint64_t key, std::string_view bytes);

}  // namespace scree
