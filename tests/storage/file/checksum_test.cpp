#include "storage/file/checksum.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace planetree::storage {
namespace {

// The bytes for which xxHash publishes known answers.
std::vector<std::byte> sanity_bytes(std::size_t count) {
  std::vector<std::byte> bytes(count);
  std::uint64_t state = 2654435761u;
  for (std::byte& byte : bytes) {
    byte = static_cast<std::byte>(state >> 56);
    state *= 11400714785074694797u;
  }
  return bytes;
}

TEST(Checksum, Hash64GivesKnownAnswers) {
  struct Known {
    std::size_t bytes;
    std::uint64_t hash;
  };
  // One length for each code path of XXH3.
  constexpr Known kKnown[] = {
      {0, 0x2d06800538d394c2},    {1, 0xc44bdff4074eecdb},   {6, 0x27b56a84cd2d7325},
      {12, 0xa713daf0dfbb77e7},   {24, 0xa3fe70bf9d3510eb},  {80, 0xbcdefbbb2c47c90a},
      {195, 0xcd94217ee362ec3a},  {403, 0xcdeb804d65c6dea4}, {512, 0x617e49599013cb6b},
      {2048, 0xdd59e2c3a5f038e0}, {2240, 0x6e73a90539cf2948}};
  for (const Known& known : kKnown) {
    EXPECT_EQ(hash64(sanity_bytes(known.bytes)), known.hash) << known.bytes;
  }
}

TEST(Checksum, Hash64TakesASeed) {
  EXPECT_EQ(hash64({}, 11400714785074694797u), 0xa8a6b918b2f0364a);
  EXPECT_EQ(hash64(sanity_bytes(80), 11400714785074694797u), 0xc6dd0cb699532e73);
}

TEST(Checksum, Hash128GivesKnownAnswers) {
  EXPECT_EQ(hash128({}), (Hash128{0x6001c324468d497f, 0x99aa06d3014798d8}));
  EXPECT_EQ(hash128(sanity_bytes(12)), (Hash128{0x061a192713f69ad9, 0x6e3efd8fc7802b18}));
  EXPECT_EQ(hash128(sanity_bytes(48)), (Hash128{0xf942219aed80f67b, 0xa002ac4e5478227e}));
  EXPECT_EQ(hash128(sanity_bytes(2048)), (Hash128{0xdd59e2c3a5f038e0, 0xf736557fd47073a5}));
}

TEST(Checksum, Hasher128IsIndependentOfPieceSizes) {
  const std::vector<std::byte> bytes = sanity_bytes(2367);
  for (const std::size_t step : {1u, 8u, 255u, 256u, 1000u, 2367u}) {
    Hasher hasher;
    for (std::size_t at = 0; at < bytes.size(); at += step) {
      hasher.add(std::span(bytes).subspan(at, std::min(step, bytes.size() - at)));
    }
    EXPECT_EQ(hasher.value(), hash128(bytes)) << step;
  }
  EXPECT_EQ(Hasher().value(), hash128({}));
}

}  // namespace
}  // namespace planetree::storage
