#include "core/base/hash.h"

#include <cstring>

namespace scree {

std::uint64_t hashBytes(const void* bytes, std::size_t byteCount, std::uint64_t seed)
{
    constexpr std::uint64_t kPrime = 0x9e3779b97f4a7c15ull;
    const auto* cursor = static_cast<const unsigned char*>(bytes);
    std::uint64_t hash = mixBits(seed + kPrime) ^ byteCount;
    for (; byteCount >= 8; byteCount -= 8, cursor += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, cursor, 8);
        hash = mixBits(hash ^ word) * kPrime;
    }
    std::uint64_t tail = 0;
    if (byteCount > 0) std::memcpy(&tail, cursor, byteCount);  // there may be nothing to point at
    return mixBits(hash ^ tail);
}

}  // namespace scree
