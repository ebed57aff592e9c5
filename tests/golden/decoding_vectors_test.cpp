// "Test vectors" of the specification hold for the independent reader and for the library.

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>

#include "octree/geometry/child_bounds.h"
#include "tests/golden/spec_reader.h"
#include "tests/golden/spec_text.h"

namespace planetree::golden {
namespace {

SpecTable vectors(std::size_t table) {
  SpecTable found = spec_tables("Test vectors").at(table);
  EXPECT_GE(found.rows.size(), 4u);
  return found;
}

float as_float(const std::string& bits) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(std::stoul(bits, nullptr, 16)));
}

std::string bits_of(float value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%08x", std::bit_cast<std::uint32_t>(value));
  return text;
}

TEST(DecodingVectors, HoldForNormals) {
  for (const TableRow& row : vectors(0).rows) {
    const auto u = static_cast<std::int16_t>(std::stoi(row.at(0)));
    const auto v = static_cast<std::int16_t>(std::stoi(row.at(1)));
    const SpecVector read = decode_normal(u, v);
    const std::array<float, 3> library = octree::unpack_normal({u, v});
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(bits_of(read[axis]), row.at(2 + axis)) << u << ' ' << v;
      EXPECT_EQ(bits_of(library[axis]), row.at(2 + axis)) << u << ' ' << v;
    }
  }
}

TEST(DecodingVectors, HoldForBoxes) {
  for (const TableRow& row : vectors(1).rows) {
    const float low = as_float(row.at(0)), high = as_float(row.at(1));
    const auto lower = static_cast<std::uint8_t>(std::stoi(row.at(2)));
    const auto upper = static_cast<std::uint8_t>(std::stoi(row.at(3)));
    const SpecBox read = decode_box({{low, low, low}, {high, high, high}}, {lower, lower, lower},
                                    {upper, upper, upper});
    octree::PackedChild packed;
    packed.lower = {lower, lower, lower};
    packed.upper = {upper, upper, upper};
    const octree::FloatBox library =
        octree::unpack_box({{low, low, low}, {high, high, high}}, packed);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(bits_of(read.lower[axis]), row.at(4));
      EXPECT_EQ(bits_of(read.upper[axis]), row.at(5));
      EXPECT_EQ(bits_of(library.lower[axis]), row.at(4));
      EXPECT_EQ(bits_of(library.upper[axis]), row.at(5));
    }
  }
}

TEST(DecodingVectors, HoldForUnits) {
  for (const TableRow& row : vectors(2).rows) {
    const float dx = as_float(row.at(0)), dy = as_float(row.at(1)), dz = as_float(row.at(2));
    EXPECT_EQ(bits_of(decode_unit(dx, dy, dz)), row.at(3));
    EXPECT_EQ(bits_of(octree::plane_step(dx, dy, dz)), row.at(3));
  }
}

}  // namespace
}  // namespace planetree::golden
