#include "octree/geometry/octcode.h"

#include <gtest/gtest.h>

namespace planetree::octree {
namespace {

constexpr std::uint32_t kMax = (1u << kLevels) - 1;

TEST(Octcode, SpreadsBitsThreeApartAndGathersThem) {
  EXPECT_EQ(spread_bits(0b1011), 0b1000001001u);
  EXPECT_EQ(spread_bits(kMax), 0x49249249249249u);
  for (std::uint32_t value = 1; value <= kMax; value = value * 3 + 1)
    EXPECT_EQ(gather_bits(spread_bits(value)), value);
  EXPECT_EQ(gather_bits(~std::uint64_t{0}), kMax);
}

TEST(Octcode, PutsXInTheLowestBitOfEachTriple) {
  EXPECT_EQ(morton_code(1, 0, 0), 1u);
  EXPECT_EQ(morton_code(0, 1, 0), 2u);
  EXPECT_EQ(morton_code(0, 0, 1), 4u);
  EXPECT_EQ(morton_code(0, 2, 0), 16u);
  EXPECT_EQ(morton_code(kMax, kMax, kMax), (std::uint64_t{1} << kMortonBits) - 1);
}

TEST(Octcode, EmptyPrefixIsTheRoot) {
  EXPECT_EQ(octcode_of_prefix(morton_code(kMax, 5, 9), 0), 0u);
}

TEST(Octcode, RoundTripsEveryPrefix) {
  const std::uint32_t x = 0x5a5a5, y = 0x12345, z = 0x7ffff;
  for (unsigned level = 0; level <= kLevels; ++level) {
    const Cell cell = cell_of_octcode(octcode_of_prefix(morton_code(x, y, z), 3 * level));
    EXPECT_EQ(cell.level, level);
    EXPECT_EQ(cell.within, 0u);
    EXPECT_EQ(cell.x, x >> (kLevels - level));
    EXPECT_EQ(cell.y, y >> (kLevels - level));
    EXPECT_EQ(cell.z, z >> (kLevels - level));
  }
}

TEST(Octcode, NamesTheSplitsWithinALevel) {
  const Cell cell = cell_of_octcode(octcode_of_prefix(morton_code(kMax, kMax, kMax), 3 * 4 + 2));
  EXPECT_EQ(cell.level, 4u);
  EXPECT_EQ(cell.within, 2u);
}

TEST(Octcode, PutsACellBeforeEveryCellInsideIt) {
  const std::uint64_t morton = morton_code(0x2bad5, 0x0f0f0, 0x77777);
  for (unsigned bits = 0; bits < kMortonBits; ++bits)
    EXPECT_LT(octcode_of_prefix(morton, bits), octcode_of_prefix(morton, bits + 1)) << bits;
}

TEST(Octcode, OrdersOneLevelByMortonCode) {
  for (std::uint64_t code = 0; code < 511; ++code) {
    const std::uint64_t here = code << (kMortonBits - 9), next = (code + 1) << (kMortonBits - 9);
    EXPECT_LT(octcode_of_prefix(here, 9), octcode_of_prefix(next, 9));
  }
}

TEST(Octcode, ReadsAnyBitsAsACellOfItsLevel) {
  for (const std::uint64_t octcode : {~std::uint64_t{0}, std::uint64_t{31} << 59}) {
    const Cell cell = cell_of_octcode(octcode);
    EXPECT_EQ(cell.level, 31u);
    EXPECT_LE(cell.x, kMax);
  }
}

}  // namespace
}  // namespace planetree::octree
