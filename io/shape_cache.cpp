#include "io/shape_cache.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "io/atomic_file.h"
#include "io/file_bytes.h"
#include "io/shape_bytes.h"
#include "io/text_forms.h"

namespace scree {
namespace {

namespace fs = std::filesystem;

constexpr const char *kFieldEnding = ".field", *kSolidEnding = ".solid";

/// Programs of other versions may share the folder: each finds what it has kept itself.
fs::path fieldName(std::uint64_t key)
{
    return toHex(key) + "-" + std::to_string(kFieldVersion) + kFieldEnding;
}

fs::path solidName(std::uint64_t key)
{
    return toHex(key) + "-" + std::to_string(kSolidVersion) + kSolidEnding;
}

/// A run that has something to keep first removes what was not used for longest beyond this: nobody
/// looks into such a folder before it has filled a disk.
constexpr std::uint64_t kMostBytes = std::uint64_t{4} << 30;

struct CacheFile {
    fs::path path;
    std::uint64_t bytes;
    fs::file_time_type used;
};

bool isOurs(const fs::path& name)
{
    return name.extension() == kFieldEnding || name.extension() == kSolidEnding;
}

std::vector<CacheFile> filesIn(const fs::path& folder)
{
    std::vector<CacheFile> files;
    std::error_code failure;
    for (fs::directory_iterator entry(folder, failure), end; entry != end;
         entry.increment(failure)) {
        if (failure) break;
        if (!isOurs(entry->path())) continue;
        const std::uint64_t bytes = entry->file_size(failure);
        if (failure) continue;  // another run has removed it
        files.push_back({entry->path(), bytes, entry->last_write_time(failure)});
    }
    return files;
}

std::uint64_t totalOf(const std::vector<CacheFile>& files)
{
    std::uint64_t bytes = 0;
    for (const CacheFile& file : files) bytes += file.bytes;
    return bytes;
}

void removeLongUnused(const fs::path& folder)
{
    std::vector<CacheFile> files = filesIn(folder);
    std::ranges::sort(files, {}, &CacheFile::used);
    std::uint64_t left = totalOf(files);
    std::error_code ignored;
    for (const CacheFile& file : files) {
        if (left <= kMostBytes) return;
        fs::remove(file.path, ignored);
        left -= file.bytes;
    }
}

}  // namespace

ShapeCache::ShapeCache(fs::path folder) : folder_(std::move(folder)) {}

std::optional<DistanceField> ShapeCache::findField(std::uint64_t key)
{
    return find(folder_ / fieldName(key), key, fieldOfBytes);
}

void ShapeCache::keepField(std::uint64_t key, const DistanceField& field)
{
    keep(folder_ / fieldName(key), bytesOfField(key, field));
}

std::optional<TriMesh> ShapeCache::findSolid(std::uint64_t key)
{
    return find(folder_ / solidName(key), key, solidOfBytes);
}

void ShapeCache::keepSolid(std::uint64_t key, const TriMesh& solid)
{
    keep(folder_ / solidName(key), bytesOfSolid(key, solid));
}

template <class What>
std::optional<What> ShapeCache::find(const fs::path& file, std::uint64_t key,
                                     std::optional<What> (*read)(std::uint64_t, std::string_view))
{
    std::error_code ignored;
    if (folder_.empty() || !fs::exists(file, ignored)) return std::nullopt;
    std::string problem = "\"" + file.string() + "\" is damaged and is made anew";
    try {
        if (std::optional<What> what = read(key, readFileBytes(file))) {
            fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
            const std::lock_guard guard(lock_);
            ++found_;
            return what;
        }
    } catch (const Error& error) {
        problem = error.what();
    }
    const std::lock_guard guard(lock_);
    problem_ = problem;
    return std::nullopt;
}

void ShapeCache::keep(const fs::path& file, const std::string& bytes)
{
    if (folder_.empty()) return;
    try {
        tidyOnce();
        writeFileBytes(file, bytes);
        const std::lock_guard guard(lock_);
        ++kept_;
    } catch (const Error& error) {
        const std::lock_guard guard(lock_);
        problem_ = error.what();
    }
}

void ShapeCache::tidyOnce()
{
    const std::lock_guard guard(lock_);
    if (std::exchange(isTidy_, true)) return;
    std::error_code failure;
    fs::create_directories(folder_, failure);
    removeAbandonedIn(folder_, [](const std::string& name) { return isOurs(name); });
    removeLongUnused(folder_);
}

ShapeCache::Size ShapeCache::size() const
{
    const std::vector<CacheFile> files = filesIn(folder_);
    return {static_cast<int>(files.size()), totalOf(files)};
}

std::filesystem::path defaultCacheFolder()
{
    const auto named = [](const char* variable) {
        const char* value = std::getenv(variable);
        return std::filesystem::path(value ? value : "");
    };
    // A path that is not absolute is to be ignored, says the XDG specification.
    if (const auto cache = named("XDG_CACHE_HOME"); cache.is_absolute()) return cache / "scree";
    if (const auto home = named("HOME"); home.is_absolute()) return home / ".cache" / "scree";
    return {};
}

}  // namespace scree
