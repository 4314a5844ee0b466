// The two 128-bit hashes that Alembic stores: MurmurHash3 x64 128 [App] names the bytes of a
// sample, SpookyHash V2 [Jen] names properties and objects. Both with seed 0.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace scree {

struct Digest {
    std::uint64_t h1 = 0;
    std::uint64_t h2 = 0;

    bool operator==(const Digest&) const = default;
};

Digest murmurDigest(std::string_view bytes);
Digest spookyDigest(std::string_view bytes);

/// The digest of a run of samples, extended by the next sample: the closing mix of SpookyHash.
Digest chainDigests(const Digest& run, const Digest& next);

/// Appends the 16 bytes of a digest as they stand in a file.
void appendDigest(std::string& bytes, const Digest& digest);

}  // namespace scree
