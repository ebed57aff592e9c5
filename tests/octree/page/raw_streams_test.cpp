#include "octree/page/page_streams.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "octree/builder/tree/stream_writer.h"
#include "tests/octree/page/raw_page.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

template <class T>
void expect_round_trip(const std::vector<T>& values) {
  StreamWriter writer;
  writer.byte_split(values);
  const std::vector<std::byte> bytes = writer.take();
  ASSERT_EQ(bytes.size(), values.size() * sizeof(T));
  const ByteSplit<T> stream(bytes.data(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(stream[i], values[i]);
}

TEST(ByteSplit, ReadsWhatStreamWriterWrote) {
  expect_round_trip<std::uint8_t>({0, 255, 7});
  expect_round_trip<std::int16_t>({-32768, -1, 0, 32767});
  expect_round_trip<std::uint32_t>({0xdeadbeef, 1});
  expect_round_trip<float>({-0.1f, 3e38f, 1e-40f});
  expect_round_trip<double>({-0.1, 1e300, 5e-324});
  expect_round_trip<std::uint64_t>({0x0123456789abcdef});
  expect_round_trip<double>({});
}

TEST(StreamWriter, PutsAllFirstBytesFirst) {
  StreamWriter writer;
  writer.byte_split(std::vector<std::uint16_t>{0x0201, 0x0403});
  const std::vector<std::byte> expected{std::byte{1}, std::byte{3}, std::byte{2}, std::byte{4}};
  EXPECT_EQ(writer.take(), expected);
}

class RawStreamsTest : public testing::Test {
 protected:
  RawStreamsTest() : pages_(build_sample(sphere(3), 262144)), raw_(pages_.raw(0)) {}

  SamplePages pages_;
  std::vector<std::byte> raw_;
};

TEST_F(RawStreamsTest, SplitAPageIntoItsStreams) {
  RawStreams streams;
  ASSERT_EQ(streams.read(raw_, BlockShape{}), nullptr);
  EXPECT_EQ(streams.head.triangle_count, 512);
  EXPECT_EQ(streams.child_counts.size(), streams.head.node_count);
  EXPECT_EQ(streams.vertices32.size(), 3u * streams.head.vertex_count);
  EXPECT_EQ(streams.id_steps32.size(), 512u - streams.head.block_count);
  EXPECT_EQ(RawPage::of(raw_).bytes(), raw_);
}

TEST_F(RawStreamsTest, ReadHeightFieldBitFromTriangleCounts) {
  RawPage page = RawPage::of(raw_);
  const std::vector<std::uint8_t> counts = page.triangle_counts;
  const std::size_t marked = counts.size() / 2;
  page.triangle_counts[marked] |= kHeightFieldBit;
  const std::vector<std::byte> raw = page.bytes();
  RawStreams streams;
  ASSERT_EQ(streams.read(raw, BlockShape{}), nullptr);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    EXPECT_EQ(streams.triangle_count(i), counts[i] & kCountBits);
    EXPECT_EQ(streams.compact(i), (counts[i] & kCompactBit) != 0);
    EXPECT_EQ(streams.is_height_field(i), i == marked);
  }
  for (const unsigned count : {0u, 17u, 63u}) {
    page.triangle_counts[marked] = static_cast<std::uint8_t>(kHeightFieldBit | count);
    EXPECT_STREQ(streams.read(page.bytes(), BlockShape{}), "a block's counts are out of range");
  }
}

TEST_F(RawStreamsTest, RefuseEveryShorterPage) {
  for (std::size_t size = 0; size < raw_.size(); ++size) {
    const std::vector<std::byte> part(raw_.begin(),
                                      raw_.begin() + static_cast<std::ptrdiff_t>(size));
    RawStreams streams;
    const char* fault = streams.read(part, BlockShape{});
    ASSERT_NE(fault, nullptr) << size;
    EXPECT_STREQ(fault, "the page is shorter than its counts say") << size;
  }
}

TEST_F(RawStreamsTest, RefuseALongerPage) {
  raw_.push_back(std::byte{0});
  RawStreams streams;
  EXPECT_STREQ(streams.read(raw_, BlockShape{}), "the page is longer than its counts say");
}

TEST_F(RawStreamsTest, RefuseAPageOfAnotherShape) {
  for (const BlockShape shape : {BlockShape{true, false}, BlockShape{false, true}}) {
    RawStreams streams;
    EXPECT_STREQ(streams.read(raw_, shape), "the page is shorter than its counts say");
  }
}

TEST_F(RawStreamsTest, NeverReadBeyondThePage) {
  // Under the address sanitizer a read past the vector's end fails the test.
  for (std::size_t at = 16; at < sizeof(PageHead); ++at)
    for (const unsigned value : {0u, 1u, 127u, 255u}) {
      std::vector<std::byte> changed = raw_;
      changed[at] = static_cast<std::byte>(value);
      RawStreams streams;
      const bool accepted = streams.read(changed, BlockShape{}) == nullptr;
      EXPECT_TRUE(!accepted || changed[at] == raw_[at] || at >= 20) << at;
    }
}

}  // namespace
}  // namespace planetree::octree
