// Objects, properties and samples of an Alembic file from anywhere; alembic_archive.h says what
// they are. It knows no schema: alembic_import.h does. Files that stand on their head end in
// Error{badInput}.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/alembic_archive.h"
#include "io/ogawa_reader.h"

namespace scree {

/// An object as a file has it.
struct StoredObject {
    std::string name;
    std::string metadata;
    OgawaWord group = kEmptyGroup;
};

/// A property as a file has it. Samples before the first change equal sample 0, those after the
/// last one equal that; `firstChange` 0: they are all equal.
struct StoredProperty {
    AlembicLayout layout;
    std::uint32_t sampleCount = 0, firstChange = 0, lastChange = 0;
    OgawaWord group = kEmptyGroup;
};

/// The value of a key in "key=value;key=value"; empty when there is none.
std::string_view metadataValue(std::string_view metadata, std::string_view key);

class AlembicReader {
public:
    explicit AlembicReader(const std::string& path);

    /// The object that stands above all others.
    StoredObject top() const;
    std::vector<StoredObject> children(const StoredObject& parent) const;

    std::vector<StoredProperty> properties(const StoredObject& object) const;
    std::vector<StoredProperty> properties(const StoredProperty& compound) const;

    /// The bytes of a sample, which live as long as the reader.
    std::string_view sample(const StoredProperty& property, std::uint32_t index) const;

    /// When a sample was taken [s].
    double secondsOf(const StoredProperty& property, std::uint32_t index) const;

    [[noreturn]] void refuse(const std::string& why) const { file_.refuse(why); }

private:
    struct Sampling {
        std::vector<double> times;  // of the first cycle [s]
        double step = 1.0;          // from cycle to cycle [s]
    };

    void readSamplings(std::string_view bytes);
    void readMetadataTable(std::string_view bytes);
    std::vector<StoredProperty> readProperties(OgawaWord compound) const;

    OgawaReader file_;
    OgawaWord top_ = kEmptyGroup;
    std::vector<Sampling> samplings_;
    std::vector<std::string> metadata_;  // by index; 0 is none
};

}  // namespace scree
