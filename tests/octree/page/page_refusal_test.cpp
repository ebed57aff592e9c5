#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <regex>
#include <set>
#include <string>

#include "octree/page/page_decoder.h"
#include "tests/octree/page/decoder_messages.h"
#include "tests/octree/page/raw_page.h"
#include "tests/octree/support/sample_tree.h"

// Reaches every message with which a page is refused, by one change to a valid page each.
namespace planetree::octree {
namespace {

constexpr float kHuge = 3e38f;
const float kNaN = std::numeric_limits<float>::quiet_NaN();
const float kInfinity = std::numeric_limits<float>::infinity();

// Sets the kind of child `child` of node `node`.
void set_kind(RawPage& page, std::size_t node, unsigned child, unsigned kind) {
  auto& kinds = page.child_kinds[node];
  kinds = static_cast<std::uint16_t>((kinds & ~(3u << (2 * child))) | kind << (2 * child));
}

unsigned kind(const RawPage& page, std::size_t node, unsigned child) {
  return page.child_kinds[node] >> (2 * child) & 3u;
}

// Turns all of a node's children of kind `from` into kind `to`.
void turn_kinds(RawPage& page, std::size_t node, unsigned from, unsigned to) {
  for (unsigned child = 0; child < page.child_counts[node]; ++child)
    if (kind(page, node, child) == from) set_kind(page, node, child, to);
}

std::size_t corner_offset(const RawPage& page, std::size_t block) {
  std::size_t offset = 0;
  for (std::size_t i = 0; i < block; ++i)
    offset += corner_bytes(page.triangle_counts[i] & kCountBits, page.vertex_counts[i]);
  return offset;
}

std::size_t ref_offset(const RawPage& page, std::size_t block) {
  std::size_t offset = 0;
  for (std::size_t i = 0; i < block; ++i)
    offset += static_cast<std::size_t>(page.vertex_counts[i] - page.new_counts[i]);
  return offset;
}

// Index of the first block for which `holds`.
std::size_t find_block(const RawPage& page, const std::function<bool(std::size_t)>& holds) {
  for (std::size_t i = 0; i < page.triangle_counts.size(); ++i)
    if (holds(i)) return i;
  ADD_FAILURE() << "no block of the sample suits";
  return 0;
}

std::size_t compact_block(const RawPage& page) {
  return find_block(page,
                    [&](std::size_t i) { return page.triangle_counts[i] > (kCompactBit | 1); });
}

enum class From { kWhole, kUpper, kBlock };

struct Corruption {
  const char* sentence;
  From from;  ///< which sample: a page with the whole tree, one with links to others, one block
  void (*corrupt)(RawPage&, PageInfo&);
};

using P = RawPage;
using F = PageInfo;

std::vector<Corruption> head_corruptions() {
  return {
      {"the page holds no record", From::kWhole,
       [](P& p, F&) { p.head.node_count = p.head.block_count = 0; }},
      {"the count of subtree roots does not fit", From::kWhole,
       [](P& p, F&) { p.head.root_count = 0; }},
      {"the count of subtree roots does not fit", From::kWhole,
       [](P& p, F&) { p.head.root_count = static_cast<std::uint16_t>(p.head.node_count + 1); }},
      {"the count of subtree roots does not fit", From::kBlock,
       [](P& p, F&) { p.head.root_count = 1; }},
      {"the counts of children do not fit", From::kWhole,
       [](P& p, F&) {
         p.head.child_count = static_cast<std::uint16_t>(kFanOut * p.head.node_count + 1);
       }},
      {"the counts of children do not fit", From::kWhole,
       [](P& p, F&) {
         p.head.page_link_count = static_cast<std::uint16_t>(p.head.child_count + 1);
       }},
      {"the count of triangles does not fit", From::kWhole,
       [](P& p, F&) {
         p.head.triangle_count =
             static_cast<std::uint16_t>(kMaxBlockTriangles * p.head.block_count + 1);
       }},
      {"the count of triangles does not fit", From::kWhole,
       [](P& p, F&) {
         p.head.triangle_count = static_cast<std::uint16_t>(p.head.block_count - 1);
       }},
      {"a reserved field is not zero", From::kWhole, [](P& p, F&) { p.head.reserved[2] = 1; }},
      {"the page is shorter than its counts say", From::kWhole,
       [](P& p, F&) { p.id_steps.clear(); }},
      {"the page is longer than its counts say", From::kWhole,
       [](P& p, F&) { p.id_steps.push_back(0); }},
      {"it is another page's bytes", From::kWhole, [](P& p, F&) { ++p.head.page_number; }},
      {"its octcode is not the directory's", From::kWhole, [](P&, F& f) { f.octcode ^= 1; }},
      {"its records do not fit a page", From::kWhole, [](P&, F& f) { f.page_bytes = 4096; }},
  };
}

std::vector<Corruption> node_corruptions() {
  return {
      {"a subtree's box is not a box", From::kWhole, [](P& p, F&) { p.root_boxes[1] = kNaN; }},
      {"a subtree's box is not a box", From::kWhole, [](P& p, F&) { p.root_boxes[5] = kInfinity; }},
      {"a subtree's box is not a box", From::kWhole,
       [](P& p, F&) { std::swap(p.root_boxes[2], p.root_boxes[5]); }},
      {"a node's box is too large", From::kWhole,
       [](P& p, F&) {
         p.root_boxes[0] = -kHuge;
         p.root_boxes[3] = kHuge;
       }},
      {"a node has no parent", From::kWhole, [](P& p, F&) { turn_kinds(p, 0, 0, 1); }},
      {"a node's child count is out of range", From::kWhole,
       [](P& p, F&) { p.child_counts[0] = 0; }},
      {"a node's child count is out of range", From::kWhole,
       [](P& p, F&) { p.child_counts[1] = 9; }},
      {"a node's height is out of range", From::kWhole, [](P& p, F&) { p.heights[0] = 0; }},
      {"a node's height is out of range", From::kWhole,
       [](P& p, F&) { p.heights[0] = kMaxHeight + 1; }},
      {"a node is higher than its parent", From::kWhole,
       [](P& p, F&) { p.heights[1] = p.heights[0]; }},
      {"an absent child has a kind", From::kWhole,
       [](P& p, F&) {
         const auto at = std::ranges::find_if(p.child_counts, [](auto n) { return n < kFanOut; });
         ASSERT_NE(at, p.child_counts.end());
         set_kind(p, static_cast<std::size_t>(at - p.child_counts.begin()), 7, 1);
       }},
      {"a child's moments are out of range", From::kWhole,
       [](P& p, F&) { p.child_dipoles.back() = -32768; }},
      {"a child's moments are out of range", From::kWhole,
       [](P& p, F&) { p.child_quadrupoles.back() = -128; }},
      {"a child's moments are out of range", From::kWhole,
       [](P& p, F&) { p.child_areas[1] = 0x7f80; }},
      {"a child's moments are out of range", From::kWhole,
       [](P& p, F&) { p.child_areas[1] = 0x8100; }},
      {"a child's moments are out of range", From::kWhole,
       [](P& p, F&) { p.child_second_moments[0] = 0x007f; }},
      {"a child is of unknown kind", From::kWhole, [](P& p, F&) { set_kind(p, 0, 0, 3); }},
      {"a block has no parent", From::kBlock, [](P&, F& f) { f.page_count = 2; }},
      {"a block has no parent", From::kBlock, [](P& p, F&) { p.repeat_block(); }},
      {"its children do not add up", From::kWhole,
       [](P& p, F&) { turn_kinds(p, p.child_counts.size() - 1, 1, 0); }},
      {"its children do not add up", From::kWhole,
       [](P& p, F&) {
         p.child_kinds.back() = static_cast<std::uint16_t>(
             p.child_kinds.back() & ((1u << (2 * (p.child_counts.back() - 1u))) - 1));
         --p.child_counts.back();
       }},
      {"its children do not add up", From::kWhole,
       [](P& p, F&) {
         const auto at = std::ranges::find_if(p.child_counts, [](auto n) { return n < kFanOut; });
         ASSERT_NE(at, p.child_counts.end());
         p.child_counts.back() = kFanOut;
         ++*at;
       }},
      {"a child's box is not a box", From::kWhole,
       [](P& p, F&) {
         p.child_boxes[0] = 9;
         p.child_boxes[3u * p.head.child_count] = 247;
       }},
      {"a child's planes are crossed", From::kWhole,
       [](P& p, F&) {
         p.child_slabs[0] = 9;
         p.child_slabs[p.head.child_count] = 8;
       }},
      {"its page links do not add up", From::kWhole, [](P& p, F&) { set_kind(p, 0, 0, 2); }},
      {"a link leads to a page that cannot be below it", From::kUpper,
       [](P& p, F&) { p.linked_pages[0] = 0; }},
      {"a link leads to a page that cannot be below it", From::kUpper,
       [](P& p, F& f) { p.linked_pages[0] = f.page_count; }},
      {"a link leads to a page that cannot be below it", From::kUpper,
       [](P& p, F&) { p.linked_pages.back() = 0xffffffff; }},
      {"a link leads to a node that no page can have", From::kUpper,
       [](P& p, F& f) {
         p.linked_nodes[0] = static_cast<std::uint16_t>(max_page_nodes(f.page_bytes, f.shape));
       }},
      {"a link leads to a node that no page can have", From::kUpper,
       [](P& p, F&) { p.linked_nodes.back() = 0xffff; }},
  };
}

std::vector<Corruption> block_corruptions() {
  return {
      {"a block's counts are out of range", From::kWhole,
       [](P& p, F&) { p.triangle_counts[0] &= kCompactBit; }},
      {"a block's counts are out of range", From::kWhole,
       [](P& p, F&) { p.triangle_counts[0] = kCompactBit | 17; }},
      {"a block's counts are out of range", From::kWhole,
       [](P& p, F&) { p.triangle_counts[0] |= kCompactBit >> 1; }},
      {"a cap is in a height field", From::kWhole,
       [](P& p, F&) { p.triangle_counts.back() |= kHeightFieldBit; }},
      {"a block's counts are out of range", From::kWhole, [](P& p, F&) { p.vertex_counts[0] = 0; }},
      {"a block's counts are out of range", From::kWhole,
       [](P& p, F&) { p.vertex_counts[0] = 49; }},
      {"a block's counts are out of range", From::kWhole,
       [](P& p, F&) { p.new_counts[0] = static_cast<std::uint8_t>(p.vertex_counts[0] + 1); }},
      {"the blocks' triangles do not add up", From::kWhole,
       [](P& p, F&) { --p.triangle_counts[0]; }},
      {"its vertices do not add up", From::kWhole, [](P& p, F&) { --p.new_counts.back(); }},
      {"its vertices do not add up", From::kWhole,
       [](P& p, F&) {
         ++p.head.vertex_count;
         p.vertices.insert(p.vertices.end(), 3, 0.0f);
       }},
      {"its vertices do not add up", From::kWhole,
       [](P& p, F&) {
         ++p.head.vertex_ref_count;
         p.vertex_refs.push_back(1);
       }},
      {"a block names a vertex twice, or one the page has not had", From::kWhole,
       [](P& p, F&) {
         const std::size_t block = find_block(
             p, [&](std::size_t i) { return p.vertex_counts[i] - p.new_counts[i] >= 2; });
         p.vertex_refs[ref_offset(p, block) + 1] = 0;
       }},
      {"a block names a vertex twice, or one the page has not had", From::kWhole,
       [](P& p, F&) { p.vertex_refs[0] = 0xffff; }},
      {"a corner names a vertex its block has not", From::kWhole,
       [](P& p, F&) {
         const std::size_t block = find_block(p, [&](std::size_t i) {
           return p.vertex_counts[i] != 16 && p.vertex_counts[i] != 32;
         });
         p.corners[corner_offset(p, block)] = std::byte{0xff};
       }},
      {"padding is not zero", From::kWhole,
       [](P& p, F&) {
         const std::size_t block = find_block(p, [&](std::size_t i) {
           return 3u * (p.triangle_counts[i] & kCountBits) * corner_bits(p.vertex_counts[i]) % 8 !=
                  0;
         });
         p.corners[corner_offset(p, block + 1) - 1] |= std::byte{0x80};
       }},
      {"a vertex is out of range", From::kWhole, [](P& p, F&) { p.vertices[4] = kNaN; }},
      {"a vertex is out of range", From::kWhole, [](P& p, F&) { p.vertices.back() = -kInfinity; }},
      {"a vertex is out of range", From::kWhole, [](P& p, F&) { p.vertices[1] = kHuge; }},
      {"a block is compact that cannot be", From::kWhole,
       [](P& p, F&) {
         p.triangle_counts[find_block(p, [&](auto i) { return p.vertex_counts[i] > 16; })] |=
             kCompactBit;
       }},
      {"a block is not as compact as its indices are", From::kWhole,
       [](P& p, F&) { p.triangle_counts[compact_block(p)] &= kCountBits; }},
      {"a block is not as compact as its indices are", From::kWhole,
       [](P& p, F&) {
         const std::size_t block = compact_block(p);
         std::size_t step = 0;
         for (std::size_t i = 0; i < block; ++i) step += (p.triangle_counts[i] & kCountBits) - 1;
         p.id_steps[step] = 0x10000;
       }},
      {"triangle indices do not ascend", From::kWhole, [](P& p, F&) { p.id_steps[0] = 0; }},
      {"triangle indices do not ascend", From::kWhole,
       [](P& p, F&) { p.first_ids[0] = 0xffffffff; }},
  };
}

std::vector<Corruption> all_corruptions() {
  std::vector<Corruption> all = head_corruptions();
  for (const auto& more : {node_corruptions(), block_corruptions()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

// A sphere without some of its triangles, so that blocks differ in size.
Soup holed_sphere(unsigned levels) {
  Soup soup = sphere(levels);
  for (std::size_t i = soup.size(); i-- > 0;)
    if (i % 11 == 5 || i % 37 == 3) soup.erase(soup.begin() + static_cast<std::ptrdiff_t>(i));
  return soup;
}

TEST(PageRefusal, ReportsFaultAndPage) {
  const SampleTree whole = build_sample(holed_sphere(3), 262144, 0, true);
  const SampleTree upper = build_sample(holed_sphere(4), 4096, 0, true);
  const SampleTree block = build_sample(sphere(0), 4096);
  const SamplePages whole_pages(whole), upper_pages(upper), block_pages(block);
  ASSERT_EQ(whole_pages.size(), 1u);
  ASSERT_FALSE(RawPage::of(upper_pages.raw(0), upper.shape).linked_pages.empty());
  for (const Corruption& corruption : all_corruptions()) {
    SCOPED_TRACE(corruption.sentence);
    const auto of = [&](const auto& a, const auto& b, const auto& c) -> const auto& {
      return corruption.from == From::kWhole ? a : corruption.from == From::kUpper ? b : c;
    };
    PageInfo info = page_info(of(whole, upper, block), 0);
    RawPage page = RawPage::of(of(whole_pages, upper_pages, block_pages).raw(0), info.shape);
    SampleFrame frame(info.page_bytes);
    ASSERT_TRUE(decode_page(page.bytes(), info, frame.bytes()));
    corruption.corrupt(page, info);
    frame = SampleFrame(info.page_bytes);
    const auto decoded = decode_page(page.bytes(), info, frame.bytes());
    ASSERT_FALSE(decoded);
    EXPECT_EQ(decoded.error().code, ErrorCode::kDamaged);
    EXPECT_EQ(decoded.error().page, info.page_number);
    EXPECT_EQ(std::string(decoded.error().text),
              std::string("page 0 is damaged: ") + corruption.sentence + "; build the file again");
  }
}

TEST(PageRefusal, CoversEveryMessageOfTheDecoder) {
  std::set<std::string> reached;
  for (const Corruption& corruption : all_corruptions()) reached.insert(corruption.sentence);
  expect_every_message(reached, {"page_streams", "page_decoder", "block_decoder"});
}

TEST(PageRefusal, HoldsForWideIdsAndFloat64) {
  const SampleTree sample = build_sample(scattered(100, 0.2), 262144, std::uint64_t{1} << 33);
  ASSERT_TRUE(sample.shape.float64 && sample.shape.wide_ids);
  const SamplePages pages(sample);
  const PageInfo info = page_info(sample, 0);
  SampleFrame frame(info.page_bytes);
  RawStreams streams;
  ASSERT_EQ(streams.read(pages.raw(0), sample.shape), nullptr);
  // The stream of id steps ends the page; the stream of first ids is before it.
  std::vector<std::byte> raw = pages.raw(0);
  const std::size_t steps = streams.id_steps64.size();
  for (std::size_t k = 1; k <= 8; ++k) raw[raw.size() - k * steps] = std::byte{0xff};
  auto decoded = decode_page(raw, info, frame.bytes());
  ASSERT_FALSE(decoded);
  EXPECT_NE(std::string(decoded.error().text).find("indices do not ascend"), std::string::npos);
  raw = pages.raw(0);
  const std::size_t ids = 8 * (steps + streams.head.block_count);
  const std::size_t coordinates = 3u * streams.head.vertex_count;
  // Sets the two highest bytes of the last coordinate: an exponent of all ones.
  raw[raw.size() - ids - 1] = std::byte{0x7f};
  raw[raw.size() - ids - 1 - coordinates] = std::byte{0xff};
  decoded = decode_page(raw, info, frame.bytes());
  ASSERT_FALSE(decoded);
  EXPECT_NE(std::string(decoded.error().text).find("a vertex is out of range"), std::string::npos);
}

}  // namespace
}  // namespace planetree::octree
