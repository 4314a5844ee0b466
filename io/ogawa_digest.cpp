#include "io/ogawa_digest.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include "io/byte_order.h"

namespace scree {

namespace {

using std::rotl;
using std::uint64_t;

/// Up to eight bytes as a number; missing ones count as zero.
uint64_t partialWord(std::string_view bytes)
{
    uint64_t word = 0;
    if (!bytes.empty()) std::memcpy(&word, bytes.data(), std::min<std::size_t>(bytes.size(), 8));
    return word;
}

// ---- MurmurHash3 [App]

constexpr uint64_t kMurmur1 = 0x87c37b91114253d5ull;
constexpr uint64_t kMurmur2 = 0x4cf5ad432745937full;

uint64_t scrambleLow(uint64_t word)
{
    return rotl(word * kMurmur1, 31) * kMurmur2;
}

uint64_t scrambleHigh(uint64_t word)
{
    return rotl(word * kMurmur2, 33) * kMurmur1;
}

uint64_t finishMurmur(uint64_t h)
{
    h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdull;
    h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53ull;
    return h ^ (h >> 33);
}

// ---- SpookyHash [Jen]

constexpr uint64_t kSpooky = 0xdeadbeefdeadbeefull;
constexpr std::size_t kLongFrom = 192;  // bytes; shorter messages use four words of state
constexpr std::size_t kBlock = 96;      // bytes of the long form's block

using ShortState = std::array<uint64_t, 4>;
using LongState = std::array<uint64_t, 12>;

void mixShort(ShortState& h)
{
    constexpr int kTurns[12] = {50, 52, 30, 41, 54, 48, 38, 37, 62, 34, 5, 36};
    for (std::size_t j = 0; j < 12; ++j) {
        uint64_t& x = h[(j + 2) % 4];
        x = rotl(x, kTurns[j]) + h[(j + 3) % 4];
        h[j % 4] ^= x;
    }
}

Digest endShort(ShortState h)
{
    constexpr int kTurns[11] = {15, 52, 26, 51, 28, 9, 47, 54, 32, 25, 63};
    for (std::size_t j = 0; j < 11; ++j) {
        uint64_t& x = h[(j + 3) % 4];
        uint64_t& y = h[(j + 2) % 4];
        x ^= y;
        y = rotl(y, kTurns[j]);
        x += y;
    }
    return {h[0], h[1]};
}

Digest spookyShort(std::string_view bytes)
{
    ShortState h = {0, 0, kSpooky, kSpooky};
    const uint64_t length = bytes.size();
    for (; bytes.size() >= 32; bytes.remove_prefix(32)) {
        h[2] += readBytes<uint64_t>(bytes, 0);
        h[3] += readBytes<uint64_t>(bytes, 8);
        mixShort(h);
        h[0] += readBytes<uint64_t>(bytes, 16);
        h[1] += readBytes<uint64_t>(bytes, 24);
    }
    if (bytes.size() >= 16) {
        h[2] += readBytes<uint64_t>(bytes, 0);
        h[3] += readBytes<uint64_t>(bytes, 8);
        mixShort(h);
        bytes.remove_prefix(16);
    }

    h[3] += length << 56;
    if (bytes.empty()) {
        h[2] += kSpooky;
        h[3] += kSpooky;
    } else {
        h[2] += partialWord(bytes);
        if (bytes.size() > 8) h[3] += partialWord(bytes.substr(8));
    }
    return endShort(h);
}

void addBlock(LongState& s, std::string_view block)
{
    constexpr int kTurns[12] = {11, 32, 43, 31, 17, 28, 39, 57, 55, 54, 22, 46};
    for (std::size_t i = 0; i < 12; ++i) {
        s[i] += readBytes<uint64_t>(block, 8 * i);
        s[(i + 2) % 12] ^= s[(i + 10) % 12];
        s[(i + 11) % 12] ^= s[i];
        s[i] = rotl(s[i], kTurns[i]);
        s[(i + 11) % 12] += s[(i + 1) % 12];
    }
}

void endLong(LongState& s)
{
    constexpr int kTurns[12] = {44, 15, 34, 21, 38, 33, 10, 13, 38, 53, 42, 54};
    for (std::size_t i = 0; i < 12; ++i) {
        s[(i + 11) % 12] += s[(i + 1) % 12];
        s[(i + 2) % 12] ^= s[(i + 11) % 12];
        s[(i + 1) % 12] = rotl(s[(i + 1) % 12], kTurns[i]);
    }
}

Digest spookyLong(std::string_view bytes)
{
    LongState s;
    for (std::size_t i = 0; i < 12; ++i) s[i] = i % 3 == 2 ? kSpooky : 0;
    for (; bytes.size() >= kBlock; bytes.remove_prefix(kBlock))
        addBlock(s, bytes.substr(0, kBlock));

    std::string last(bytes);
    last.resize(kBlock, '\0');
    last.back() = static_cast<char>(bytes.size());
    for (std::size_t i = 0; i < 12; ++i) s[i] += readBytes<uint64_t>(last, 8 * i);
    for (int round = 0; round < 3; ++round) endLong(s);
    return {s[0], s[1]};
}

}  // namespace

Digest murmurDigest(std::string_view bytes)
{
    Digest digest;
    auto& [h1, h2] = digest;
    const uint64_t length = bytes.size();
    for (; bytes.size() >= 16; bytes.remove_prefix(16)) {
        h1 ^= scrambleLow(readBytes<uint64_t>(bytes, 0));
        h1 = (rotl(h1, 27) + h2) * 5 + 0x52dce729;
        h2 ^= scrambleHigh(readBytes<uint64_t>(bytes, 8));
        h2 = (rotl(h2, 31) + h1) * 5 + 0x38495ab5;
    }
    if (bytes.size() > 8) h2 ^= scrambleHigh(partialWord(bytes.substr(8)));
    if (!bytes.empty()) h1 ^= scrambleLow(partialWord(bytes));

    h1 ^= length;
    h2 ^= length;
    h1 += h2;
    h2 += h1;
    h1 = finishMurmur(h1);
    h2 = finishMurmur(h2);
    h1 += h2;
    h2 += h1;
    return digest;
}

Digest spookyDigest(std::string_view bytes)
{
    return bytes.size() < kLongFrom ? spookyShort(bytes) : spookyLong(bytes);
}

Digest chainDigests(const Digest& run, const Digest& next)
{
    return endShort({run.h1, run.h2, next.h1, next.h2});
}

void appendDigest(std::string& bytes, const Digest& digest)
{
    appendBytes(bytes, digest.h1);
    appendBytes(bytes, digest.h2);
}

}  // namespace scree
