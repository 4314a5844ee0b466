// The blocks of an Ogawa file from anywhere: every word and size is checked before it is used.
// What the blocks are is said in ogawa_file.h.
#pragma once

#include <string>
#include <string_view>

#include "io/ogawa_file.h"

namespace scree {

class OgawaReader {
public:
    /// Throws Error{missingInput} when there is no file, and Error{badInput}, as all that follows
    /// does, when it is no Ogawa file or was not completed.
    explicit OgawaReader(const std::string& path);

    OgawaWord root() const { return root_; }
    std::uint64_t childCount(OgawaWord group) const;
    OgawaWord child(OgawaWord group, std::uint64_t index) const;

    /// The bytes of a data block; they live as long as the reader.
    std::string_view data(OgawaWord word) const;

    /// Throws Error{badInput}: "it " and why.
    [[noreturn]] void refuse(const std::string& why) const;

private:
    /// Where a block with a count of things of `size` bytes begins, once it is sure to fit.
    std::uint64_t checkedBlock(std::uint64_t offset, std::uint64_t size) const;

    std::string bytes_;
    OgawaWord root_ = kEmptyGroup;
};

}  // namespace scree
