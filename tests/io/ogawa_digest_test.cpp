#include "io/ogawa_digest.h"

#include <gtest/gtest.h>

#include "io/ogawa_file.h"

namespace scree {
namespace {

/// Byte i is (7 i + 3) mod 256.
std::string message(std::size_t length)
{
    std::string bytes;
    for (std::size_t i = 0; i < length; ++i) bytes += static_cast<char>((7 * i + 3) % 256);
    return bytes;
}

// Reference values for messages of every code path: empty, tails, whole blocks, and both sides of
// the length from which SpookyHash takes its long form.
struct Vector {
    std::size_t length;
    Digest murmur, spooky;
};

constexpr Vector kVectors[] = {
    {0, {0, 0}, {0x232706fc6bf50919, 0x8b72ee65b4e851c7}},
    {1, {0x726ac6dd306a3e59, 0x4e711127c5b5a8e4}, {0x4b87fa4c899cff30, 0x81b68b651a1176a5}},
    {15, {0xba6a4b5e80ade4f4, 0xe00e5a8ff7e8f26d}, {0x80ff2557a5f3fce9, 0x9f9124303074ed55}},
    {16, {0xc4b099c52f8f4ea1, 0x7d670219d92afe48}, {0x996b234d7cd0c4ed, 0x8a808f0f205dfad7}},
    {31, {0x9d91fedff00436fb, 0x7ea851ba737ebfd0}, {0xb8cc43d889b92e0c, 0x833b8c390ccc43c5}},
    {48, {0x32778697f8bf8cd3, 0x09c739cdcec43d06}, {0xf091978edcfaf617, 0x918b6eb70dd4be18}},
    {191, {0x1fe9f31966e1e391, 0xcd5de6960f030416}, {0x5a8b556721e70004, 0xbfbe8ba61a7acb43}},
    {192, {0x3f0edf07f7957b3d, 0x697b2bf45b7eece5}, {0x4bd5231fc1b3b9cf, 0xf70d440762d6f476}},
    {500, {0xfefd503fc9effc79, 0xe3d436371887cdc9}, {0xf0c6a863ba8c7a80, 0x3150ef955303028a}},
    {1000, {0x0af789efbadcaa49, 0x0bd8a1b9d9bb546b}, {0x85072d3218a51b05, 0x2412672ca9b5bf48}},
};

TEST(OgawaDigest, AgreesWithTheReferenceValuesOfBothHashes)
{
    for (const Vector& vector : kVectors) {
        EXPECT_EQ(murmurDigest(message(vector.length)), vector.murmur) << vector.length;
        EXPECT_EQ(spookyDigest(message(vector.length)), vector.spooky) << vector.length;
    }
}

TEST(OgawaDigest, AChainDependsOnTheOrderOfItsSamples)
{
    const Digest a = murmurDigest("a"), b = murmurDigest("b");
    EXPECT_FALSE(chainDigests(a, b) == chainDigests(b, a));
}

TEST(OgawaWord, HoldsOffsetsBeyondFourGibibytes)
{
    constexpr std::uint64_t kFar = 0x7'0000'1234;
    EXPECT_EQ(static_cast<std::uint64_t>(groupAt(kFar)), kFar);
    EXPECT_EQ(static_cast<std::uint64_t>(dataAt(kFar)), 0x8000'0007'0000'1234);
}

}  // namespace
}  // namespace scree
