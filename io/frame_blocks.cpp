#include "io/frame_blocks.h"

#include "core/base/check.h"
#include "core/base/error.h"
#include "core/base/hash.h"

namespace scree {
namespace {

template <std::size_t N>
void copyText(std::array<char, N>& target, const std::string& text)
{
    SCREE_CHECK(text.size() < N, text);
    std::memcpy(target.data(), text.data(), text.size());
}

}  // namespace

void FrameEncoder::addBytes(const std::string& name, const std::string& type, std::uint64_t rows,
                            std::uint64_t columns, std::string_view bytes)
{
    BlockEntry entry;
    copyText(entry.name, name);
    copyText(entry.type, type);
    entry.rows = rows;
    entry.columns = columns;
    entries_.push_back(entry);
    contents_.emplace_back(bytes);
    contents_.back().resize((bytes.size() + 7) / 8 * 8, '\0');
}

std::string FrameEncoder::finish(FrameHeader header)
{
    // Place the blocks behind header and table.
    std::uint64_t offset = sizeof(FrameHeader) + entries_.size() * sizeof(BlockEntry);
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        entries_[i].offset = offset;
        offset += contents_[i].size();
    }
    header.blockCount = static_cast<std::uint32_t>(entries_.size());
    header.byteCount = offset + sizeof(std::uint64_t);

    // Write everything in file order, the checksum last.
    std::string bytes;
    bytes.reserve(header.byteCount);
    bytes.append(reinterpret_cast<const char*>(&header), sizeof header);
    bytes += bytesOf(entries_);
    for (const std::string& content : contents_) bytes += content;
    appendBytes(bytes, hashBytes(bytes.data(), bytes.size()));
    return bytes;
}

FrameDecoder::FrameDecoder(std::string_view bytes, const std::filesystem::path& path)
    : bytes_(bytes), path_(path)
{
    readHeader();
    readTable();
}

std::uint64_t FrameDecoder::rowsOf(const std::string& name) const
{
    const auto found = blocks_.find(name);
    return found == blocks_.end() ? 0 : found->second.rows;
}

std::string_view FrameDecoder::find(const std::string& name, const std::string& type,
                                    std::size_t elementBytes, std::uint64_t rows,
                                    std::uint64_t columns) const
{
    const auto found = blocks_.find(name);
    if (found == blocks_.end()) fail("the block \"" + name + "\" is missing");
    const BlockEntry& entry = found->second;
    if (entry.type.data() != type || entry.rows != rows || entry.columns != columns)
        fail("the block \"" + name + "\" has another type or size than expected");
    // First by division: a product of what a file says may be more than any number holds.
    const std::uint64_t most = bytes_.size() / (columns * elementBytes);
    const std::uint64_t size = rows * columns * elementBytes;
    if (entry.offset > bytes_.size() || rows > most || size > bytes_.size() - entry.offset)
        fail("the block \"" + name + "\" lies outside the file");
    return bytes_.substr(entry.offset, size);
}

void FrameDecoder::fail(const std::string& why) const
{
    throw Error(ErrorKind::inputOutput, {path_.string(), 0, 0}, why);
}

void FrameDecoder::readHeader()
{
    if (bytes_.size() < sizeof(FrameHeader) + sizeof(std::uint64_t))
        fail("cut short: " + std::to_string(bytes_.size()) + " bytes are less than a header");
    std::memcpy(&header_, bytes_.data(), sizeof(FrameHeader));
    if (header_.magic != kFrameMagic) fail("not a frame file of a Scree take");
    if (header_.version != kFrameFileVersion)
        fail("frame file version " + std::to_string(header_.version) +
             "; this program reads version " + std::to_string(kFrameFileVersion));
    if (header_.byteCount != bytes_.size())
        fail("cut short or grown: " + std::to_string(bytes_.size()) + " bytes, written with " +
             std::to_string(header_.byteCount));
    const std::size_t contentSize = bytes_.size() - sizeof(std::uint64_t);
    if (readBytes<std::uint64_t>(bytes_, contentSize) != hashBytes(bytes_.data(), contentSize))
        fail("damaged: the checksum does not fit the contents");
}

void FrameDecoder::readTable()
{
    if (header_.blockCount > (bytes_.size() - sizeof(FrameHeader)) / sizeof(BlockEntry))
        fail("the block table lies outside the file");
    for (std::uint32_t i = 0; i < header_.blockCount; ++i) {
        BlockEntry entry;
        std::memcpy(&entry, bytes_.data() + sizeof(FrameHeader) + i * sizeof(BlockEntry),
                    sizeof entry);
        entry.name.back() = entry.type.back() = '\0';
        blocks_[entry.name.data()] = entry;
    }
}

}  // namespace scree
