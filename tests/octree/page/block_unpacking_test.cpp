#include "octree/page/block_unpacking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "octree/page/page_streams.h"
#include "tests/octree/support/each_target.h"

namespace planetree::octree {
namespace {

using Corners = std::array<std::array<unsigned, 3>, kMaxBlockTriangles>;

std::vector<std::byte> packed(const Corners& corners, unsigned triangle_count,
                              unsigned vertex_count) {
  const unsigned bits = corner_bits(vertex_count);
  std::vector<std::byte> bytes(corner_bytes(triangle_count, vertex_count));
  for (unsigned bit = 0; bit < 3 * triangle_count * bits; ++bit) {
    const unsigned field = bit / bits;
    if (corners[field / 3][field % 3] >> bit % bits & 1) bytes[bit / 8] |= std::byte{1} << bit % 8;
  }
  return bytes;
}

/// Unpacked corners and whether the unpacker accepted them.
struct UnpackedCorners {
  BlockCorners corners;
  bool good;
};

UnpackedCorners unpack(const std::vector<std::byte>& bytes, unsigned triangle_count,
                       unsigned vertex_count) {
  UnpackedCorners unpacked{};
  unpacked.good = unpack_corners(bytes, triangle_count, vertex_count, unpacked.corners);
  return unpacked;
}

class CornersTest : public testing::TestWithParam<unsigned> {
 protected:
  Corners random_corners() {
    Corners corners;
    for (auto& triangle : corners)
      for (unsigned& corner : triangle) corner = static_cast<unsigned>(random_() % vertex_count_);
    return corners;
  }

  std::mt19937_64 random_{1};
  const unsigned vertex_count_ = GetParam();
};

// Tested with nothing and with other bytes after the packed corners.
TEST_P(CornersTest, UnpackAndRepeatTheLastTriangle) {
  for (unsigned triangles = 1; triangles <= kMaxBlockTriangles; ++triangles)
    for (const std::size_t behind : {0, 7, 60}) {
      const Corners corners = random_corners();
      auto bytes = packed(corners, triangles, vertex_count_);
      bytes.insert(bytes.end(), behind, std::byte{0xff});
      const auto unpacked = on_each_target([&] { return unpack(bytes, triangles, vertex_count_); });
      for (const UnpackedCorners& one : unpacked) {
        EXPECT_TRUE(one.good);
        for (unsigned lane = 0; lane < kMaxBlockTriangles; ++lane)
          for (unsigned k = 0; k < 3; ++k) {
            const unsigned corner = corners[std::min(lane, triangles - 1)][k];
            ASSERT_EQ(one.corners.row[k][lane], corner);
            if (vertex_count_ > BlockHeader::kMaxCompactVertices) continue;
            ASSERT_EQ(one.corners.packed[k] >> BlockHeader::corner_bit(lane) & 15, corner);
          }
      }
    }
}

// With 16 or 32 vertices every value that fits the packed bits is a valid corner.
class WrongCornersTest : public CornersTest {};

TEST_P(WrongCornersTest, AreRefusedInEveryTriangle) {
  for (unsigned triangle = 0; triangle < kMaxBlockTriangles; ++triangle)
    for (unsigned k = 0; k < 3; ++k) {
      Corners corners = random_corners();
      corners[triangle][k] = vertex_count_;
      for (const unsigned triangles : {triangle + 1, kMaxBlockTriangles}) {
        const auto bytes = packed(corners, triangles, vertex_count_);
        for (const UnpackedCorners& one :
             on_each_target([&] { return unpack(bytes, triangles, vertex_count_); }))
          ASSERT_FALSE(one.good);
      }
      if (triangle == 0) continue;
      const auto before = packed(corners, triangle, vertex_count_);
      for (const UnpackedCorners& one :
           on_each_target([&] { return unpack(before, triangle, vertex_count_); }))
        ASSERT_TRUE(one.good);
    }
}

INSTANTIATE_TEST_SUITE_P(VertexCounts, CornersTest,
                         testing::Values(1, 3, 15, 16, 17, 31, 32, 33, 47, 48));
INSTANTIATE_TEST_SUITE_P(VertexCounts, WrongCornersTest,
                         testing::Values(1, 3, 15, 17, 31, 33, 47, 48));

std::vector<std::byte> byte_split(const std::vector<float>& values) {
  std::vector<std::byte> bytes(4 * values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k)
      bytes[k * values.size() + i] =
          static_cast<std::byte>(std::bit_cast<std::uint32_t>(values[i]) >> 8 * k);
  return bytes;
}

struct UnpackedVertices {
  std::vector<float> at;
  bool good;
};

// Input order: x of all vertices, then y, then z. Checks that the float after the output is not
// written.
UnpackedVertices unpack(const std::vector<float>& values) {
  const std::vector<std::byte> bytes = byte_split(values);
  UnpackedVertices unpacked{std::vector<float>(values.size() + 1, -7.0f), false};
  unpacked.good =
      unpack_vertices(ByteSplit<float>(bytes.data(), values.size()), unpacked.at.data());
  EXPECT_EQ(unpacked.at.back(), -7.0f);
  return unpacked;
}

TEST(UnpackVertices, InterleavesCoordinates) {
  std::mt19937_64 random(2);
  for (std::size_t count = 0; count <= 70; ++count) {
    std::vector<float> values(3 * count);
    for (float& value : values)
      value = std::bit_cast<float>(static_cast<std::uint32_t>(random()) & 0xdcffffffU);
    for (const UnpackedVertices& one : on_each_target([&] { return unpack(values); })) {
      EXPECT_TRUE(one.good);
      for (std::size_t i = 0; i < 3 * count; ++i)
        ASSERT_EQ(std::bit_cast<std::uint32_t>(one.at[i]),
                  std::bit_cast<std::uint32_t>(values[i % 3 * count + i / 3]));
    }
  }
}

TEST(UnpackVertices, RefusesNonFiniteAndHugeCoordinates) {
  using Limits = std::numeric_limits<float>;
  const float most = 0x1p112f;
  for (const std::size_t count : {16, 21})
    for (std::size_t i = 0; i < 3 * count; ++i) {
      std::vector<float> values(3 * count, 0.5f);
      const auto good_with = [&](float value) {
        values[i] = value;
        const auto all = on_each_target([&] { return unpack(values).good; });
        EXPECT_EQ(std::count(all.begin(), all.end(), all[0]), std::ssize(all));
        return bool(all[0]);
      };
      for (const float value : {most, -most, 0.0f, -0.0f}) ASSERT_TRUE(good_with(value));
      for (const float value : {most * 1.0000001f, -most * 1.0000001f, Limits::infinity(),
                                -Limits::infinity(), Limits::quiet_NaN(), -Limits::quiet_NaN()})
        ASSERT_FALSE(good_with(value)) << value << " at " << i;
    }
}

TEST(UnpackRows, GathersRowsAndReturnsLargestSquaredDistance) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<float> coordinate(-1, 1);
  std::vector<float> vertices(3 * 100 + 1);
  for (float& value : vertices) value = coordinate(random);
  for (const unsigned stride : {16U, 24U, 32U, 48U}) {
    std::vector<std::uint16_t> indices(stride);
    for (std::uint16_t& index : indices) index = static_cast<std::uint16_t>(random() % 100);
    std::vector<float> expected(3 * stride);
    float square = 0;
    for (unsigned i = 0; i < stride; ++i) {
      float d[3];
      for (unsigned axis = 0; axis < 3; ++axis) {
        expected[axis * stride + i] = vertices[3 * indices[i] + axis];
        d[axis] = expected[axis * stride + i] - expected[axis * stride];
      }
      square = std::max(square, d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    }
    const auto all = on_each_target([&] {
      std::vector<float> rows(3 * stride);
      const float greatest = unpack_rows(vertices.data(), indices.data(), stride, rows.data());
      rows.push_back(greatest);
      return rows;
    });
    expected.push_back(square);
    for (const std::vector<float>& one : all) ASSERT_EQ(one, expected) << stride;
  }
}

}  // namespace
}  // namespace planetree::octree
