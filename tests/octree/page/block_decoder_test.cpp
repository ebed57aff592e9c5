#include "octree/page/block_decoder.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <vector>

#include "octree/page/frame.h"
#include "tests/octree/support/each_target.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

/// Blocks of one triangle each with a random number of vertices, none shared between blocks. The
/// decoder writes the records of the first blocks over the input vertices of all blocks.
class BlocksWithoutSharedVertices {
 public:
  explicit BlocksWithoutSharedVertices(std::uint64_t seed) {
    Noise noise(seed);
    const std::size_t blocks = 1 + noise.bits() % 30;
    for (std::size_t i = 0; i < blocks; ++i) {
      vertex_counts_.push_back(static_cast<std::byte>(1 + noise.bits() % kMaxBlockVertices));
      corners_.resize(corners_.size() + corner_bytes(1, vertex_count(i)));
      first_new_.push_back(vertex_count_);
      vertex_count_ += vertex_count(i);
    }
    for (std::size_t i = 0; i < blocks; ++i)
      counts_.push_back(is_compact(i) ? std::byte{kCompactBit | 1} : std::byte{1});
    ids_.resize(4 * blocks);
    vertices_.resize(std::size_t{12} * vertex_count_);
    for (std::size_t i = 0; i < 3 * std::size_t{vertex_count_}; ++i) {
      coordinates_.push_back(static_cast<float>(noise.uniform(-1, 1)));
      for (std::size_t k = 0; k < 4; ++k)
        vertices_[k * 3 * vertex_count_ + i] =
            static_cast<std::byte>(std::bit_cast<std::uint32_t>(coordinates_[i]) >> 8 * k);
    }
  }

  std::size_t size() const { return vertex_counts_.size(); }
  unsigned vertex_count(std::size_t block) const {
    return std::to_integer<unsigned>(vertex_counts_[block]);
  }
  bool is_compact(std::size_t block) const { return vertex_count(block) <= 16; }
  float coordinate(std::size_t block, unsigned vertex, unsigned axis) const {
    return coordinates_[axis * vertex_count_ + first_new_[block] + vertex];
  }

  RawStreams streams() const {
    RawStreams streams;
    const std::size_t blocks = size();
    streams.head.block_count = static_cast<std::uint16_t>(blocks);
    streams.head.triangle_count = streams.head.block_count;
    streams.head.vertex_count = static_cast<std::uint16_t>(vertex_count_);
    streams.triangle_counts = {counts_.data(), blocks};
    streams.vertex_counts = streams.new_counts = {vertex_counts_.data(), blocks};
    streams.corners = corners_;
    streams.vertices32 = {vertices_.data(), 3 * std::size_t{vertex_count_}};
    streams.first_ids32 = {ids_.data(), blocks};
    return streams;
  }

 private:
  std::uint32_t vertex_count_ = 0;
  std::vector<std::uint32_t> first_new_;
  std::vector<float> coordinates_;
  std::vector<std::byte> vertex_counts_, counts_, corners_, vertices_, ids_;
};

// About half of the records overlap their own input vertices, half do not.
TEST(BlockDecoder, DecodesInPlaceWithoutOverwritingUnreadVertices) {
  constexpr BlockShape kShape;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const BlocksWithoutSharedVertices blocks(seed);
    const RawStreams streams = blocks.streams();
    std::vector<std::size_t> slot{0};
    for (std::size_t i = 0; i < blocks.size(); ++i)
      slot.push_back(slot[i] + kShape.slots(blocks.vertex_count(i), blocks.is_compact(i)));
    struct alignas(kSlotBytes) Slot {
      std::byte bytes[kSlotBytes];
    };
    const auto all = on_each_target([&] {
      std::vector<Slot> slots(slot.back());
      BlockDecoder decoder(streams, kShape);
      EXPECT_EQ(decoder.start(slots[0].bytes), nullptr);
      for (std::size_t i = blocks.size(); i-- > 0;)
        EXPECT_EQ(decoder.decode_last(slots[slot[i]].bytes), nullptr);
      return slots;
    });
    for (const std::vector<Slot>& slots : all)
      for (std::size_t i = 0; i < blocks.size(); ++i) {
        const BlockView block(slots[slot[i]].bytes, kShape);
        for (unsigned vertex = 0; vertex < block.header().stride(); ++vertex)
          for (unsigned axis = 0; axis < 3; ++axis)
            ASSERT_EQ(block.vertex(vertex)[axis],
                      blocks.coordinate(i, vertex < blocks.vertex_count(i) ? vertex : 0, axis))
                << "block " << i << " of " << blocks.size() << ", seed " << seed;
      }
  }
}

}  // namespace
}  // namespace planetree::octree
