#include "io/ogawa_file.h"

#include "core/base/check.h"
#include "io/byte_order.h"

namespace scree {

namespace {

constexpr std::string_view kIncompleteHeader("Ogawa\x00\x00\x01\0\0\0\0\0\0\0\0", 16);
constexpr std::uint64_t kCompleteAt = 5;  // offset of the byte that is FF in a complete file
constexpr std::uint64_t kRootAt = 8;      // offset of the root group's offset

}  // namespace

OgawaFile::OgawaFile(const std::filesystem::path& path) : file_(path)
{
    file_.write(kIncompleteHeader);
}

OgawaWord OgawaFile::writeData(std::string_view head, std::string_view tail)
{
    const std::uint64_t byteCount = head.size() + tail.size();
    if (byteCount == 0) return kEmptyData;
    const OgawaWord word = dataAt(file_.size());
    file_.write(&byteCount, sizeof byteCount);
    file_.write(head);
    file_.write(tail);
    return word;
}

OgawaWord OgawaFile::writeGroup(std::span<const OgawaWord> children)
{
    const std::uint64_t count = children.size();
    if (count == 0) return kEmptyGroup;
    const OgawaWord word = groupAt(file_.size());
    file_.write(&count, sizeof count);
    file_.write(children.data(), children.size_bytes());
    return word;
}

void OgawaFile::finish(OgawaWord root)
{
    SCREE_CHECK(static_cast<std::uint64_t>(root) >> 63 == 0, "the root must be a group");
    constexpr unsigned char kComplete = 0xff;
    file_.overwrite(kRootAt, &root, sizeof root);
    file_.overwrite(kCompleteAt, &kComplete, 1);
    file_.commit();
}

}  // namespace scree
