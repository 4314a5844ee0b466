// A 64-bit hash of bytes (one multiply and one mixer per 8-byte word). It names contents
// and proves that two states are equal bit for bit; it is not meant to resist an attacker.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace scree {

/// Spreads every bit of `x` over the whole word; a bijection.
constexpr std::uint64_t mixBits(std::uint64_t x)
{
    x ^= x >> 30;
    x *= 0xbf58476d1ce4e5b9ull;
    x ^= x >> 27;
    x *= 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

/// Hash of `byteCount` bytes; `seed` chains several pieces into one hash.
std::uint64_t hashBytes(const void* bytes, std::size_t byteCount, std::uint64_t seed = 0);

inline std::uint64_t hashText(std::string_view text, std::uint64_t seed = 0)
{
    return hashBytes(text.data(), text.size(), seed);
}

}  // namespace scree
