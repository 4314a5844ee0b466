#include "io/alembic_reader.h"

#include <algorithm>
#include <cmath>

#include "io/byte_cursor.h"

namespace scree {

namespace {

constexpr std::size_t kDigestBytes = 16;
constexpr unsigned kInlineMetadata = 255;

/// For a block of headers.
ByteCursor cursorOver(std::string_view headers, const OgawaReader& file)
{
    return {headers, [&file] { file.refuse("is damaged: a header is cut short"); }};
}

/// A number of 1, 2 or 4 bytes.
std::uint32_t takeSized(ByteCursor& cursor, unsigned hint)
{
    if (hint == 0) return cursor.take<std::uint8_t>();
    return hint == 1 ? cursor.take<std::uint16_t>() : cursor.take<std::uint32_t>();
}

/// A property's header; the metadata index stands for a text that the caller knows.
StoredProperty takeHeader(ByteCursor& cursor, const std::vector<std::string>& metadata,
                          const OgawaReader& file)
{
    const auto info = cursor.take<std::uint32_t>();
    const unsigned hint = info >> 2 & 3u;
    StoredProperty property;
    AlembicLayout& layout = property.layout;
    layout.kind = static_cast<AlembicKind>(std::min(info & 3u, 2u));
    layout.type = static_cast<AlembicType>(info >> 4 & 15u);
    layout.extent = static_cast<int>(info >> 12 & 255u);
    if (layout.kind != AlembicKind::compound) {
        property.sampleCount = takeSized(cursor, hint);
        const bool isConstant = info >> 11 & 1u, isStored = info >> 9 & 1u;
        property.firstChange = isStored ? takeSized(cursor, hint) : 1;
        property.lastChange = isStored               ? takeSized(cursor, hint)
                              : property.sampleCount ? property.sampleCount - 1
                                                     : 0;
        if (isConstant || property.sampleCount < 2) property.firstChange = property.lastChange = 0;
        if (property.firstChange > property.lastChange ||
            property.lastChange >= std::max(property.sampleCount, 1u)) {
            file.refuse("is damaged: a property changes when it has no samples");
        }
        if (info >> 8 & 1u) layout.sampling = static_cast<int>(takeSized(cursor, hint));
    }
    layout.name = cursor.takeText(takeSized(cursor, hint));
    const unsigned index = info >> 20 & 255u;
    if (index == kInlineMetadata) {
        layout.metadata = cursor.takeText(takeSized(cursor, hint));
    } else if (index < metadata.size()) {
        layout.metadata = metadata[index];
    }
    return property;
}

}  // namespace

std::string_view metadataValue(std::string_view metadata, std::string_view key)
{
    while (!metadata.empty()) {
        const std::string_view pair = metadata.substr(0, metadata.find(';'));
        metadata.remove_prefix(std::min(metadata.size(), pair.size() + 1));
        const std::size_t split = pair.find('=');
        if (split != std::string_view::npos && pair.substr(0, split) == key) {
            return pair.substr(split + 1);
        }
    }
    return {};
}

AlembicReader::AlembicReader(const std::string& path) : file_(path)
{
    constexpr std::uint64_t kTop = 2, kSamplings = 4, kMetadata = 5;
    top_ = file_.child(file_.root(), kTop);
    readSamplings(file_.data(file_.child(file_.root(), kSamplings)));
    readMetadataTable(file_.data(file_.child(file_.root(), kMetadata)));
}

void AlembicReader::readSamplings(std::string_view bytes)
{
    ByteCursor cursor = cursorOver(bytes, file_);
    while (!cursor.isAtEnd()) {
        cursor.take<std::uint32_t>();  // the most samples of any property
        Sampling sampling;
        sampling.step = cursor.take<double>();
        const auto count = cursor.take<std::uint32_t>();
        const std::string_view times = cursor.takeText(sizeof(double) * std::size_t{count});
        for (std::uint32_t i = 0; i < count; ++i) {
            sampling.times.push_back(readBytes<double>(times, sizeof(double) * i));
        }
        if (sampling.times.empty()) refuse("is damaged: it samples at no time");
        samplings_.push_back(std::move(sampling));
    }
}

void AlembicReader::readMetadataTable(std::string_view bytes)
{
    metadata_.emplace_back();
    ByteCursor cursor = cursorOver(bytes, file_);
    while (!cursor.isAtEnd()) metadata_.emplace_back(cursor.takeText(cursor.take<std::uint8_t>()));
}

StoredObject AlembicReader::top() const
{
    return {"", "", top_};
}

std::vector<StoredObject> AlembicReader::children(const StoredObject& parent) const
{
    const std::uint64_t count = file_.childCount(parent.group);
    if (count < 2) return {};
    std::string_view headers = file_.data(file_.child(parent.group, count - 1));
    headers.remove_suffix(std::min(headers.size(), 2 * kDigestBytes));
    std::vector<StoredObject> result;
    ByteCursor cursor = cursorOver(headers, file_);
    while (!cursor.isAtEnd()) {
        StoredObject object;
        object.name = cursor.takeText(cursor.take<std::uint32_t>());
        const unsigned index = cursor.take<std::uint8_t>();
        if (index == kInlineMetadata) {
            object.metadata = cursor.takeText(cursor.take<std::uint32_t>());
        } else if (index < metadata_.size()) {
            object.metadata = metadata_[index];
        }
        object.group = file_.child(parent.group, result.size() + 1);
        result.push_back(std::move(object));
    }
    return result;
}

std::vector<StoredProperty> AlembicReader::properties(const StoredObject& object) const
{
    return readProperties(file_.child(object.group, 0));
}

std::vector<StoredProperty> AlembicReader::properties(const StoredProperty& compound) const
{
    if (compound.layout.kind != AlembicKind::compound) return {};
    return readProperties(compound.group);
}

std::vector<StoredProperty> AlembicReader::readProperties(OgawaWord compound) const
{
    const std::uint64_t count = file_.childCount(compound);
    if (count == 0) return {};
    std::vector<StoredProperty> result;
    ByteCursor cursor = cursorOver(file_.data(file_.child(compound, count - 1)), file_);
    while (!cursor.isAtEnd()) {
        result.push_back(takeHeader(cursor, metadata_, file_));
        result.back().group = file_.child(compound, result.size() - 1);
    }
    return result;
}

std::string_view AlembicReader::sample(const StoredProperty& property, std::uint32_t index) const
{
    if (index >= property.sampleCount) refuse("is damaged: a property has too few samples");
    // What is stored: sample 0, then all from the first change to the last.
    std::uint64_t entry = 0;
    if (property.firstChange > 0 && index >= property.firstChange) {
        entry = std::min(index, property.lastChange) - property.firstChange + 1;
    }
    const bool isArray = property.layout.kind == AlembicKind::array;  // dimensions stand between
    const std::string_view bytes =
        file_.data(file_.child(property.group, isArray ? 2 * entry : entry));
    return bytes.substr(std::min(bytes.size(), kDigestBytes));
}

double AlembicReader::secondsOf(const StoredProperty& property, std::uint32_t index) const
{
    const auto number = static_cast<std::size_t>(property.layout.sampling);
    if (number >= samplings_.size()) refuse("is damaged: it does not say when a sample was taken");
    const Sampling& sampling = samplings_[number];
    const std::size_t perCycle = sampling.times.size();
    const std::size_t cycle = index / perCycle;
    const double start = sampling.times[index % perCycle];
    // A list of all times has cycles that never end.
    const double seconds = cycle == 0 ? start : start + sampling.step * static_cast<double>(cycle);
    if (!std::isfinite(seconds)) refuse("is damaged: the time of a sample is not finite");
    return seconds;
}

}  // namespace scree
