// Ogawa, the container of Alembic files: a tree whose leaves are data blocks and whose inner nodes
// are groups, each a table of 64-bit words that say where its children stand. It knows nothing of
// Alembic.
//
// Layout: 16 bytes of header ("Ogawa", a byte that is FF once the file is complete, the version 00
// 01, the root group's offset), then blocks in any order. Data block: u64 n, n bytes. Group: u64 c,
// c words.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "io/atomic_file.h"

namespace scree {

/// Where a block stands, as a group stores it. A type of its own so that nobody calculates with it.
enum class OgawaWord : std::uint64_t {};

inline constexpr OgawaWord kEmptyGroup{0};
inline constexpr OgawaWord kEmptyData{std::uint64_t{1} << 63};

/// Offset → word; offsets use 63 bits, so files beyond 4 GiB need nothing special.
constexpr OgawaWord groupAt(std::uint64_t offset)
{
    return OgawaWord{offset};
}
constexpr OgawaWord dataAt(std::uint64_t offset)
{
    return OgawaWord{offset | std::uint64_t{1} << 63};
}

/// Blocks are written children first, so that every word is known when its group is written.
/// Several groups may hold the same word: that is how bodies share a mesh.
class OgawaFile {
public:
    explicit OgawaFile(const std::filesystem::path& path);

    /// The block is the concatenation of both pieces; no block is written when both are empty.
    OgawaWord writeData(std::string_view head, std::string_view tail = {});
    OgawaWord writeGroup(std::span<const OgawaWord> children);

    /// Sets root and completeness byte, syncs, and gives the file its name.
    void finish(OgawaWord root);

private:
    AtomicFile file_;
};

}  // namespace scree
