#include "io/ogawa_reader.h"

#include "core/base/error.h"
#include "io/byte_order.h"
#include "io/file_bytes.h"

namespace scree {

namespace {

constexpr std::string_view kMagic = "Ogawa";
constexpr std::size_t kHeaderBytes = 16;
constexpr char kComplete = '\xff';
constexpr std::uint64_t kDataBit = std::uint64_t{1} << 63;

}  // namespace

OgawaReader::OgawaReader(const std::string& path) : bytes_(readFileBytes(path))
{
    if (bytes_.starts_with("\x89HDF")) {
        refuse("is an Alembic file in the old HDF5 form; save it again as Ogawa");
    }
    if (!bytes_.starts_with(kMagic)) refuse("is no Alembic file");
    if (bytes_.size() < kHeaderBytes || bytes_[5] != kComplete) {
        refuse("is not complete: whoever wrote it did not finish");
    }
    if (bytes_[6] != 0 || bytes_[7] != 1) refuse("is an Alembic file of an unknown version");
    root_ = OgawaWord{readBytes<std::uint64_t>(bytes_, 8)};
}

std::uint64_t OgawaReader::checkedBlock(std::uint64_t offset, std::uint64_t size) const
{
    if (offset < kHeaderBytes || offset > bytes_.size() - sizeof(std::uint64_t)) {
        refuse("is damaged: it points beyond its end");
    }
    const auto count = readBytes<std::uint64_t>(bytes_, offset);
    const std::uint64_t begin = offset + sizeof(std::uint64_t);
    if (count > (bytes_.size() - begin) / size) refuse("is damaged: a block is cut short");
    return begin;
}

std::uint64_t OgawaReader::childCount(OgawaWord group) const
{
    const auto offset = static_cast<std::uint64_t>(group);
    if (offset & kDataBit) refuse("is damaged: data where a group should be");
    if (group == kEmptyGroup) return 0;
    return readBytes<std::uint64_t>(bytes_, checkedBlock(offset, 8) - 8);
}

OgawaWord OgawaReader::child(OgawaWord group, std::uint64_t index) const
{
    if (index >= childCount(group)) refuse("is damaged: a group has too few children");
    return OgawaWord{
        readBytes<std::uint64_t>(bytes_, static_cast<std::uint64_t>(group) + 8 + 8 * index)};
}

std::string_view OgawaReader::data(OgawaWord word) const
{
    const auto offset = static_cast<std::uint64_t>(word);
    if (!(offset & kDataBit)) refuse("is damaged: a group where data should be");
    if (word == kEmptyData) return {};
    const std::uint64_t begin = checkedBlock(offset & ~kDataBit, 1);
    return std::string_view(bytes_).substr(begin, readBytes<std::uint64_t>(bytes_, begin - 8));
}

void OgawaReader::refuse(const std::string& why) const
{
    throw Error(ErrorKind::badInput, "it " + why);
}

}  // namespace scree
