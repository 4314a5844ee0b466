#include "io/alembic_archive.h"

#include <algorithm>

#include "core/base/check.h"
#include "io/byte_order.h"

namespace scree {

namespace {

constexpr std::int32_t kArchiveVersion = 0;
constexpr std::int32_t kLibraryVersion = 10812;  // the library whose layout we write: 1.8.12

constexpr std::uint8_t kInlineMetadata = 255;  // index that says: the text follows
constexpr std::size_t kMostTableEntries = 254;
constexpr std::size_t kLongestTableEntry = 255;

// Bits of a property header's first word.
constexpr std::uint32_t kScalarLike = 0x1;  // of an array: every sample is one value
constexpr std::uint32_t kHasSampling = 0x100;
constexpr std::uint32_t kHasChangeRange = 0x200;
constexpr std::uint32_t kHomogeneous = 0x400;
constexpr std::uint32_t kConstant = 0x800;
constexpr int kSizeHintShift = 2;
constexpr int kTypeShift = 4;
constexpr int kExtentShift = 12;
constexpr int kMetadataShift = 20;

/// Width of the integers in one property header: 1, 2 or 4 bytes, stored as 0, 1, 2.
std::uint32_t sizeHint(std::size_t largest)
{
    if (largest < 256) return 0;
    return largest < 65536 ? 1 : 2;
}

void appendSized(std::string& header, std::uint32_t hint, std::size_t value)
{
    const auto word = static_cast<std::uint32_t>(value);
    header.append(reinterpret_cast<const char*>(&word), std::size_t{1} << hint);
}

void appendNameAndMetadata(std::string& header, std::uint32_t hint, const std::string& name,
                           const std::string& metadata, std::uint8_t index)
{
    appendSized(header, hint, name.size());
    header += name;
    if (index != kInlineMetadata) return;
    appendSized(header, hint, metadata.size());
    header += metadata;
}

template <class Item>
std::string joinedDigests(std::span<const Item> items)
{
    std::string bytes;
    bytes.reserve(16 * items.size());
    for (const Item& item : items) appendDigest(bytes, item.digest);
    return bytes;
}

}  // namespace

// ---- tracks
// ---------------------------------------------------------------------------------------

void SampleTrack::append(const AlembicSample& sample)
{
    digest_ = count_ == 0 ? sample.digest : chainDigests(digest_, sample.digest);
    holdsOneValueEach_ = holdsOneValueEach_ && sample.isOneValue;
    const bool changes = count_ > 0 && sample.data != last_.data;
    if (changes) {
        // A rest since the last change lies inside the stored range now: fill it in.
        if (firstChange_ > 0) entries_.resize(1 + count_ - firstChange_, last_.data);
        if (firstChange_ == 0) firstChange_ = count_;
        lastChange_ = count_;
    }
    if (changes || count_ == 0) entries_.push_back(sample.data);
    last_ = sample;
    ++count_;
}

// ---- samples and properties
// -----------------------------------------------------------------------

AlembicArchive::AlembicArchive(const std::filesystem::path& path) : file_(path), samplings_(1) {}

int AlembicArchive::addCyclicSampling(std::vector<double> times, double step)
{
    SCREE_CHECK(!times.empty() && std::is_sorted(times.begin(), times.end()) &&
                    times.back() - times.front() < step,
                "the times of a cycle must ascend within it");
    samplings_.push_back({std::move(times), step, 0});
    return static_cast<int>(samplings_.size()) - 1;
}

AlembicSample AlembicArchive::writeScalar(std::string_view bytes)
{
    const Digest digest = murmurDigest(bytes);
    std::string head;
    appendDigest(head, digest);
    return {file_.writeData(head, bytes), digest, true};
}

AlembicSample AlembicArchive::writeArray(std::string_view bytes, std::uint64_t valueCount)
{
    // What a run of array samples digests is the sample's digest together with its dimensions; an
    // empty sample has no block and digest 0.
    AlembicSample sample = bytes.empty() ? AlembicSample{} : writeScalar(bytes);
    std::string shaped;
    appendBytes(shaped, valueCount);
    appendDigest(shaped, sample.digest);
    sample.digest = spookyDigest(shaped);
    sample.isOneValue = valueCount == 1;
    return sample;
}

AlembicProperty AlembicArchive::writeProperty(const AlembicLayout& layout, const SampleTrack& track)
{
    SCREE_CHECK(track.count() > 0, layout.name + " has no sample");
    Sampling& sampling = samplings_.at(static_cast<std::size_t>(layout.sampling));
    sampling.mostSamples = std::max(sampling.mostSamples, track.isConstant() ? 1 : track.count());
    return {writeTrack(layout, track), headerOf(layout, track), digestOf(layout, track)};
}

AlembicProperty AlembicArchive::writeConstant(const AlembicLayout& layout, std::string_view bytes)
{
    return writeProperty(layout, SampleTrack(writeScalar(bytes)));
}

AlembicProperty AlembicArchive::writeCompound(const std::string& name, const std::string& metadata,
                                              std::span<const AlembicProperty> children)
{
    AlembicProperty compound;
    compound.group = writeProperties(children);

    const std::uint8_t index = metadataIndex(metadata);
    const std::uint32_t hint = sizeHint(std::max(name.size(), metadata.size()));
    appendBytes(compound.header, std::uint32_t{index} << kMetadataShift | hint << kSizeHintShift);
    appendNameAndMetadata(compound.header, hint, name, metadata, index);

    compound.digest = spookyDigest(joinedDigests(children) + name + metadata);
    return compound;
}

OgawaWord AlembicArchive::writeProperties(std::span<const AlembicProperty> properties)
{
    if (properties.empty()) return kEmptyGroup;
    std::vector<OgawaWord> words;
    std::string headers;
    for (const AlembicProperty& property : properties) {
        words.push_back(property.group);
        headers += property.header;
    }
    words.push_back(file_.writeData(headers));
    return file_.writeGroup(words);
}

OgawaWord AlembicArchive::writeTrack(const AlembicLayout& layout, const SampleTrack& track)
{
    if (layout.kind == AlembicKind::scalar) return file_.writeGroup(track.entries());
    // Array entries are pairs of data and dimensions; lists of numbers leave the dimensions empty.
    std::vector<OgawaWord> words;
    for (const OgawaWord data : track.entries()) {
        words.push_back(data);
        words.push_back(kEmptyData);
    }
    return file_.writeGroup(words);
}

std::string AlembicArchive::headerOf(const AlembicLayout& layout, const SampleTrack& track)
{
    const std::uint8_t index = metadataIndex(layout.metadata);
    const auto sampling = static_cast<std::size_t>(layout.sampling);
    const std::uint32_t hint = sizeHint(std::max<std::size_t>(
        {layout.metadata.size(), layout.name.size(), track.count(), sampling}));
    const bool isArray = layout.kind == AlembicKind::array;
    const bool needsChangeRange = !track.isConstant() && (track.firstChange() != 1 ||
                                                          track.lastChange() + 1 != track.count());

    std::uint32_t info = static_cast<std::uint32_t>(layout.kind) | hint << kSizeHintShift |
                         static_cast<std::uint32_t>(layout.type) << kTypeShift |
                         static_cast<std::uint32_t>(layout.extent) << kExtentShift |
                         std::uint32_t{index} << kMetadataShift;
    if (isArray && track.holdsOneValueEach()) info |= kScalarLike;
    if (!isArray || layout.extent == 1) info |= kHomogeneous;
    if (sampling != 0) info |= kHasSampling;
    if (needsChangeRange) info |= kHasChangeRange;
    if (track.isConstant()) info |= kConstant;

    std::string header;
    appendBytes(header, info);
    appendSized(header, hint, track.count());
    if (needsChangeRange) {
        appendSized(header, hint, track.firstChange());
        appendSized(header, hint, track.lastChange());
    }
    if (sampling != 0) appendSized(header, hint, sampling);
    appendNameAndMetadata(header, hint, layout.name, layout.metadata, index);
    return header;
}

Digest AlembicArchive::digestOf(const AlembicLayout& layout, const SampleTrack& track) const
{
    const Sampling& sampling = samplings_[static_cast<std::size_t>(layout.sampling)];
    std::string bytes = layout.name + layout.metadata;
    appendBytes(bytes, static_cast<std::uint8_t>(layout.type));
    appendBytes(bytes, static_cast<std::uint8_t>(layout.extent));
    if (layout.kind == AlembicKind::scalar) appendBytes(bytes, std::uint8_t{0});
    appendTimes(bytes, sampling);
    appendDigest(bytes, track.digest());
    return spookyDigest(bytes);
}

// ---- objects and the archive
// ----------------------------------------------------------------------

AlembicObject AlembicArchive::writeObject(const std::string& name, const std::string& metadata,
                                          std::span<const AlembicProperty> properties,
                                          std::span<const AlembicObject> children)
{
    const Digest propertyDigest = spookyDigest(joinedDigests(properties));
    const std::string childDigests = joinedDigests(children);

    // Gather the words of properties and children, and the children's headers.
    std::vector<OgawaWord> words = {writeProperties(properties)};
    std::string headers;
    for (const AlembicObject& child : children) {
        words.push_back(child.group);
        appendBytes(headers, static_cast<std::uint32_t>(child.name.size()));
        headers += child.name;
        const std::uint8_t index = metadataIndex(child.metadata);
        appendBytes(headers, index);
        if (index != kInlineMetadata) continue;
        appendBytes(headers, static_cast<std::uint32_t>(child.metadata.size()));
        headers += child.metadata;
    }
    appendDigest(headers, propertyDigest);
    appendDigest(headers, children.empty() ? Digest{} : spookyDigest(childDigests));
    words.push_back(file_.writeData(headers));

    std::string bytes = childDigests;
    appendDigest(bytes, propertyDigest);
    return {name, metadata, file_.writeGroup(words), spookyDigest(bytes + metadata + name)};
}

void AlembicArchive::finish(std::span<const AlembicObject> roots, const std::string& metadata)
{
    const AlembicObject top = writeObject("ABC", "", {}, roots);
    const std::string_view archiveVersion(reinterpret_cast<const char*>(&kArchiveVersion), 4);
    const std::string_view libraryVersion(reinterpret_cast<const char*>(&kLibraryVersion), 4);
    const OgawaWord words[] = {
        file_.writeData(archiveVersion),
        file_.writeData(libraryVersion),
        top.group,
        file_.writeData(metadata),
        file_.writeData(samplingTable()),
        file_.writeData(metadataTable_),
    };
    file_.finish(file_.writeGroup(words));
}

std::uint8_t AlembicArchive::metadataIndex(const std::string& metadata)
{
    if (metadata.empty()) return 0;
    const auto known = metadataIndices_.find(metadata);
    if (known != metadataIndices_.end()) return known->second;
    if (metadataIndices_.size() == kMostTableEntries) return kInlineMetadata;
    if (metadata.size() > kLongestTableEntry) return kInlineMetadata;

    const auto index = static_cast<std::uint8_t>(metadataIndices_.size() + 1);
    metadataIndices_.emplace(metadata, index);
    appendBytes(metadataTable_, static_cast<std::uint8_t>(metadata.size()));
    metadataTable_ += metadata;
    return index;
}

std::string AlembicArchive::samplingTable() const
{
    std::string table;
    for (const Sampling& sampling : samplings_) {
        appendBytes(table, sampling.mostSamples);
        appendTimes(table, sampling);
    }
    return table;
}

void AlembicArchive::appendTimes(std::string& bytes, const Sampling& sampling)
{
    appendBytes(bytes, sampling.step);
    appendBytes(bytes, static_cast<std::uint32_t>(sampling.times.size()));
    for (const double time : sampling.times) appendBytes(bytes, time);
}

}  // namespace scree
