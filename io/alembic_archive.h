// Alembic's data model on top of the Ogawa container: objects hold properties, properties hold
// samples in time. It knows no schema; alembic_writer.h says what a transform or a mesh is.
//
// Everything is written children first and streamed: a sample goes to disk at once, and what stays
// in memory of it is one 8-byte word in its track.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/ogawa_digest.h"
#include "io/ogawa_file.h"

namespace scree {

/// Element types by their number in the file.
enum class AlembicType : std::uint8_t {
    boolean = 0,
    u8 = 1,
    i8 = 2,
    i32 = 6,
    u32 = 5,
    f32 = 10,
    f64 = 11,
    string = 12,
};

enum class AlembicKind : std::uint8_t { compound = 0, scalar = 1, array = 2 };

/// What a property is, apart from its samples. A scalar sample is one value, an array sample any
/// number of them; a value is `extent` elements (3 for a vector, 16 for a matrix).
struct AlembicLayout {
    std::string name;
    AlembicKind kind = AlembicKind::scalar;
    AlembicType type = AlembicType::f64;
    int extent = 1;
    int sampling = 0;      ///< index of a time sampling; 0 is the one for constants
    std::string metadata;  ///< "key=value;key=value", keys sorted
};

/// A sample that is on disk.
struct AlembicSample {
    OgawaWord data = kEmptyData;
    Digest digest;
    bool isOneValue = true;
};

/// The samples of one property in order of time. Only entry 0 and the range from the first to the
/// last change are stored, so that resting bodies cost nothing while they rest; a rest between two
/// changes costs a word a sample.
class SampleTrack {
public:
    SampleTrack() = default;
    explicit SampleTrack(const AlembicSample& first) { append(first); }

    void append(const AlembicSample& sample);
    void repeatLast() { append(last_); }

    std::uint32_t count() const { return count_; }
    bool isConstant() const { return firstChange_ == 0; }
    std::uint32_t firstChange() const { return firstChange_; }
    std::uint32_t lastChange() const { return lastChange_; }
    bool holdsOneValueEach() const { return holdsOneValueEach_; }

    /// One word per stored entry: sample 0, then the samples firstChange … lastChange.
    std::span<const OgawaWord> entries() const { return entries_; }

    /// Of all samples, repeats included.
    const Digest& digest() const { return digest_; }

private:
    std::vector<OgawaWord> entries_;
    AlembicSample last_;
    Digest digest_;
    std::uint32_t count_ = 0;
    std::uint32_t firstChange_ = 0;  // lowest sample that differs from sample 0; 0: none
    std::uint32_t lastChange_ = 0;   // highest sample that differs from the one before; 0: none
    bool holdsOneValueEach_ = true;
};

/// A property that is on disk, with what its parent has to say of it.
struct AlembicProperty {
    OgawaWord group = kEmptyGroup;
    std::string header;
    Digest digest;
};

/// An object that is on disk; name and metadata are stored by its parent.
struct AlembicObject {
    std::string name;
    std::string metadata;
    OgawaWord group = kEmptyGroup;
    Digest digest;
};

class AlembicArchive {
public:
    /// Throws Error{cannotCreate}.
    explicit AlembicArchive(const std::filesystem::path& path);

    /// Samples at the given times, ascending within less than `step` seconds, and again every
    /// `step` seconds; returns the index for AlembicLayout::sampling.
    int addCyclicSampling(std::vector<double> times, double step);

    AlembicSample writeScalar(std::string_view bytes);
    AlembicSample writeArray(std::string_view bytes, std::uint64_t valueCount);

    /// A property with the samples of `track`, which holds at least one.
    AlembicProperty writeProperty(const AlembicLayout& layout, const SampleTrack& track);

    /// A constant scalar, written with its sample.
    AlembicProperty writeConstant(const AlembicLayout& layout, std::string_view bytes);

    AlembicProperty writeCompound(const std::string& name, const std::string& metadata,
                                  std::span<const AlembicProperty> children);

    AlembicObject writeObject(const std::string& name, const std::string& metadata,
                              std::span<const AlembicProperty> properties,
                              std::span<const AlembicObject> children);

    /// Completes the file: `roots` are its outermost objects, `metadata` describes the archive.
    void finish(std::span<const AlembicObject> roots, const std::string& metadata);

private:
    struct Sampling {
        std::vector<double> times = {0.0};  // of the first cycle [s]
        double step = 1.0;                  // from cycle to cycle [s]
        std::uint32_t mostSamples = 0;      // of any property; constants count as 1
    };

    std::uint8_t metadataIndex(const std::string& metadata);
    OgawaWord writeProperties(std::span<const AlembicProperty> properties);
    OgawaWord writeTrack(const AlembicLayout& layout, const SampleTrack& track);
    std::string headerOf(const AlembicLayout& layout, const SampleTrack& track);
    Digest digestOf(const AlembicLayout& layout, const SampleTrack& track) const;
    std::string samplingTable() const;
    static void appendTimes(std::string& bytes, const Sampling& sampling);

    OgawaFile file_;
    std::vector<Sampling> samplings_;
    std::map<std::string, std::uint8_t> metadataIndices_;
    std::string metadataTable_;  // as stored: length byte and text of each entry
};

}  // namespace scree
