// The container of a frame file: blocks of numbers by name, under a checksum. What the blocks mean
// is the business of frame_file.h.
//
// Layout, little endian (io/TAKE_FORMAT.md):
//   header   64 bytes: magic, version, block count, frame, body count, shot hash, byte count
//   table    64 bytes per block: name, NumPy type, rows, columns, offset
//   blocks   each starting at a multiple of 8
//   checksum  8 bytes: hashBytes of all before it
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/byte_order.h"

namespace scree {

inline constexpr std::uint32_t kFrameFileVersion = 1;
constexpr std::array<char, 8> kFrameMagic = {'S', 'C', 'R', 'E', 'E', 'F', 'R', 'M'};

/// As it stands in the file.
struct FrameHeader {
    std::array<char, 8> magic = kFrameMagic;
    std::uint32_t version = kFrameFileVersion;
    std::uint32_t blockCount = 0;
    std::int64_t frame = 0;  ///< the shot's number; in a checkpoint that of the frame being left
    std::uint64_t bodyCount = 0;
    std::uint64_t shotHash = 0;
    std::uint64_t byteCount = 0;  ///< of the whole file, checksum included
    std::array<std::uint64_t, 2> unused = {};
};
static_assert(sizeof(FrameHeader) == 64);

/// A line of the table, as it stands in the file.
struct BlockEntry {
    std::array<char, 24> name = {};
    std::array<char, 8> type = {};  ///< as NumPy spells it: "<f8", "<i8", "<i4"
    std::uint64_t rows = 0;
    std::uint64_t columns = 0;
    std::uint64_t offset = 0;  ///< from the start of the file
    std::uint64_t unused = 0;
};
static_assert(sizeof(BlockEntry) == 64);

template <class T>
inline constexpr const char* kBlockType = nullptr;
template <>
inline constexpr const char* kBlockType<double> = "<f8";
template <>
inline constexpr const char* kBlockType<std::int64_t> = "<i8";
template <>
inline constexpr const char* kBlockType<std::int32_t> = "<i4";

/// Gathers blocks, then lays them out.
class FrameEncoder {
public:
    /// `values`: row after row, as many as fill them.
    template <class T>
    void add(const std::string& name, std::uint64_t columns, const std::vector<T>& values)
    {
        addBytes(name, kBlockType<T>, values.size() / columns, columns, bytesOf(values));
    }

    /// The bytes of the file; what is to be counted in the header is counted here.
    std::string finish(FrameHeader header);

private:
    void addBytes(const std::string& name, const std::string& type, std::uint64_t rows,
                  std::uint64_t columns, std::string_view bytes);

    std::vector<BlockEntry> entries_;
    std::vector<std::string> contents_;
};

/// Finds blocks by name; every access is checked against the size of the file. Whatever does not
/// fit throws Error{inputOutput} that names the file.
class FrameDecoder {
public:
    /// Checks header, table and checksum. The bytes must outlive the decoder.
    FrameDecoder(std::string_view bytes, const std::filesystem::path& path);

    const FrameHeader& header() const { return header_; }

    /// Rows of a block, 0 when the file has no such block.
    std::uint64_t rowsOf(const std::string& name) const;

    /// A block, which must have this type and size.
    template <class T>
    std::vector<T> read(const std::string& name, std::uint64_t rows, std::uint64_t columns) const
    {
        const std::string_view bytes = find(name, kBlockType<T>, sizeof(T), rows, columns);
        std::vector<T> values(bytes.size() / sizeof(T));
        if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    }

    [[noreturn]] void fail(const std::string& why) const;

private:
    void readHeader();
    void readTable();
    std::string_view find(const std::string& name, const std::string& type,
                          std::size_t elementBytes, std::uint64_t rows,
                          std::uint64_t columns) const;

    std::string_view bytes_;
    std::filesystem::path path_;
    FrameHeader header_;
    std::map<std::string, BlockEntry> blocks_;
};

}  // namespace scree
