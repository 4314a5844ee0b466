// File: mark, format version, key, layout, storage, four arrays (count, then elements), and the
// hash of all before it.
#include "io/distance_cache.h"

#include <cmath>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "io/atomic_file.h"
#include "io/byte_cursor.h"
#include "io/file_bytes.h"
#include "io/take_info.h"

namespace scree {
namespace {

constexpr std::string_view kMark = "scree distance field\n";
constexpr std::uint32_t kFormat = 2;
constexpr std::string_view kEnding = ".field";

template <class Element>
void appendArray(std::string& bytes, const std::vector<Element>& elements)
{
    appendBytes(bytes, static_cast<std::uint64_t>(elements.size()));
    bytes.append(reinterpret_cast<const char*>(elements.data()), sizeof(Element) * elements.size());
}

struct CutShort {};

template <class Element>
std::vector<Element> takeArray(ByteCursor& cursor)
{
    const auto count = cursor.take<std::uint64_t>();
    cursor.require(count, sizeof(Element));
    std::vector<Element> elements(count);
    cursor.takeInto(std::span(elements));
    return elements;
}

/// Whether points have places in the lattice: divisions by the spacing stay finite, too.
bool isLattice(const NodeLayout& layout)
{
    for (const int count : layout.count) {
        if (count < 2) return false;
    }
    return std::isnormal(layout.spacing) && layout.spacing > 0.0 && layout.origin.allFinite() &&
           layout.last().allFinite();
}

/// Whether the layout has as many blocks as there are. The product is never formed: it can be more
/// than any number holds, and nothing may be made of that size before it is known to be right.
bool hasItsBlocks(const DistanceNodes& nodes)
{
    std::size_t left = nodes.blocks.size();
    for (const int count : blocksAlong(nodes.layout)) {
        if (left % static_cast<std::size_t>(count) != 0) return false;
        left /= static_cast<std::size_t>(count);
    }
    return left == 1;
}

/// Whether every index stays inside its array. Only the faces are not compared: how many there are
/// is known to who has the mesh.
bool isConsistent(const DistanceField& field)
{
    const DistanceNodes& nodes = field.nodes;
    const bool isDense = nodes.storage == FieldStorage::dense;
    if (!isDense && nodes.storage != FieldStorage::bricks) return false;
    if (!isLattice(nodes.layout) || !hasItsBlocks(nodes)) return false;
    if (isDense && nodes.values.size() != nodes.layout.nodeCount()) return false;
    constexpr std::size_t kBlockLists = kBlockCells * kBlockCells * kBlockCells;
    for (const FieldBlock& block : nodes.blocks) {
        const std::size_t own = block.isCoarse ? 8 : kBrickValues;
        if (!isDense && block.first + own > nodes.values.size()) return false;
        if (isDense && block.isCoarse) return false;
        if (block.candidates != FieldBlock::kNone &&
            block.candidates + kBlockLists >= field.nearest.start.size()) {
            return false;
        }
    }
    std::uint32_t last = 0;
    for (const std::uint32_t start : field.nearest.start) {
        if (start < last || start > field.nearest.faces.size()) return false;
        last = start;
    }
    return true;
}

/// What stands between the mark and the hash. Throws CutShort.
std::optional<DistanceField> takeField(std::uint64_t key, std::string_view bytes)
{
    ByteCursor cursor(bytes, [] { throw CutShort(); });
    if (cursor.take<std::uint32_t>() != kFormat) return std::nullopt;
    if (cursor.take<std::uint64_t>() != key) return std::nullopt;
    NodeLayout layout;
    for (int axis = 0; axis < 3; ++axis) layout.origin[axis] = cursor.take<double>();
    layout.spacing = cursor.take<double>();
    for (int& count : layout.count) count = cursor.take<int>();
    DistanceField field;
    field.nodes.layout = layout;
    field.nodes.storage = static_cast<FieldStorage>(cursor.take<std::int32_t>());
    field.nodes.blocks = takeArray<FieldBlock>(cursor);
    field.nodes.values = takeArray<float>(cursor);
    field.nearest.start = takeArray<std::uint32_t>(cursor);
    field.nearest.faces = takeArray<std::uint32_t>(cursor);
    if (!cursor.isAtEnd() || !isConsistent(field)) return std::nullopt;
    field.nodes.blockCount = blocksAlong(layout);
    return field;
}

}  // namespace

std::string bytesOfField(std::uint64_t key, const DistanceField& field)
{
    const NodeLayout& layout = field.nodes.layout;
    std::string bytes(kMark);
    appendBytes(bytes, kFormat);
    appendBytes(bytes, key);
    for (int axis = 0; axis < 3; ++axis) appendBytes(bytes, layout.origin[axis]);
    appendBytes(bytes, layout.spacing);
    for (const int count : layout.count) appendBytes(bytes, count);
    appendBytes(bytes, static_cast<std::int32_t>(field.nodes.storage));
    appendArray(bytes, field.nodes.blocks);
    appendArray(bytes, field.nodes.values);
    appendArray(bytes, field.nearest.start);
    appendArray(bytes, field.nearest.faces);
    appendBytes(bytes, hashText(bytes));
    return bytes;
}

std::optional<DistanceField> fieldOfBytes(std::uint64_t key, std::string_view bytes)
{
    if (!bytes.starts_with(kMark) || bytes.size() < kMark.size() + sizeof(std::uint64_t)) {
        return std::nullopt;
    }
    const std::string_view hashed = bytes.substr(0, bytes.size() - sizeof(std::uint64_t));
    if (readBytes<std::uint64_t>(bytes, hashed.size()) != hashText(hashed)) return std::nullopt;

    try {
        return takeField(key, hashed.substr(kMark.size()));
    } catch (const CutShort&) {
        return std::nullopt;
    }
}

DistanceCache::DistanceCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

std::filesystem::path DistanceCache::fileOf(std::uint64_t key) const
{
    return folder_ / (toHex(key) + std::string(kEnding));
}

std::optional<DistanceField> DistanceCache::find(std::uint64_t key)
{
    std::error_code ignored;
    if (folder_.empty() || !std::filesystem::exists(fileOf(key), ignored)) return std::nullopt;
    try {
        auto field = fieldOfBytes(key, readFileBytes(fileOf(key)));
        if (field) {
            ++found_;
            return field;
        }
        problem_ = "\"" + fileOf(key).string() + "\" is damaged and is built anew";
    } catch (const Error& error) {
        problem_ = error.what();
    }
    return std::nullopt;
}

void DistanceCache::keep(std::uint64_t key, const DistanceField& field)
{
    if (folder_.empty()) return;
    try {
        std::error_code failure;
        std::filesystem::create_directories(folder_, failure);
        const auto isField = [](const std::string& name) { return name.ends_with(kEnding); };
        if (kept_ == 0) removeAbandonedIn(folder_, isField);
        writeFileBytes(fileOf(key), bytesOfField(key, field));
        ++kept_;
    } catch (const Error& error) {
        problem_ = error.what();
    }
}

DistanceCache::Size DistanceCache::size() const
{
    Size size;
    std::error_code failure;
    for (std::filesystem::directory_iterator entry(folder_, failure), end; entry != end;
         entry.increment(failure)) {
        if (failure) break;
        if (entry->path().extension() != kEnding) continue;
        ++size.files;
        size.bytes += entry->file_size(failure);
    }
    return size;
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
