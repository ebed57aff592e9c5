#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "octree/nearest/nearest.h"
#include "octree/page/page_decoder.h"
#include "octree/page/page_streams.h"
#include "octree/winding/winding_number.h"
#include "tests/fuzz/fuzz_frame.h"

/// Decodes arbitrary bytes as pages of a small file and queries the tree they form. Input by
/// offset:
///
///   0  block format and page size, see kFloat64 and the constants after it
///   1  length of the first page, 2 bytes, little-endian
///   3  page 0, then one page that serves as every other page
///
/// The page numbers are set to the expected ones and the expected keys to those in the pages,
/// because few inputs would pass these comparisons.
namespace planetree::octree {
namespace {

constexpr std::uint8_t kFloat64 = 1;
constexpr std::uint8_t kWideIds = 2;
constexpr std::uint8_t kLargePages = 4;
constexpr std::uint8_t kRootIsBlock = 8;
constexpr std::uint8_t kMoments = 16;
constexpr std::uint8_t kNumbers = 32;
constexpr std::uint32_t kPageCount = 64;

struct Pages {
  Frame* root;
  Frame* other;  // null if it does not decode
};

bool decode(std::span<const std::byte> bytes, PageInfo info, Frame& frame) {
  std::vector<std::byte> raw(bytes.begin(), bytes.end());
  PageHead head{};
  const std::size_t head_bytes = std::min(raw.size(), sizeof head);
  std::copy_n(raw.begin(), head_bytes, reinterpret_cast<std::byte*>(&head));
  head.page_number = info.page_number;
  std::copy_n(reinterpret_cast<const std::byte*>(&head), head_bytes, raw.begin());
  info.octcode = head.octcode;
  return static_cast<bool>(decode_page(raw, info, frame.bytes()));
}

void check(const NearestAnswer& answer) {
  const bool beyond = answer.status == Status::kBeyondMaxDistance;
  const double values[] = {answer.lower,
                           beyond ? 0 : answer.distance,
                           beyond ? 0 : answer.upper,
                           answer.point.x(),
                           answer.point.y(),
                           answer.point.z(),
                           answer.barycentric[0],
                           answer.barycentric[1],
                           answer.barycentric[2]};
  for (const double value : values)
    if (!std::isfinite(value)) std::abort();
  if (!(answer.lower < answer.upper) || answer.lower < 0) std::abort();
}

void query_winding(const TreeInfo& tree, const Point& query, PageReader reader) {
  TraversalStats work;
  const WindingNumber found = winding_number(tree, query, tree.record_count, reader, work);
  if (!std::isfinite(found.value) || !(found.error >= 0)) std::abort();
  if (work.nodes + work.blocks > tree.record_count) std::abort();
}

void query_tree(const TreeInfo& tree, Pages& pages) {
  const PageReader reader{&pages,
                          [](void* context, std::uint32_t page) noexcept -> const std::byte* {
                            const auto& both = *static_cast<Pages*>(context);
                            Frame* frame = page == 0 ? both.root : both.other;
                            return frame ? frame->bytes().data() : nullptr;
                          }};
  const Point queries[] = {{0.1, 0.2, 0.3}, {-3, 0, 1}, {1e9, -1e9, 1}, {1e90, 0, 0}};
  NearestLimits some;
  some.max_error = 0.1;
  some.max_distance = 0.7;
  for (const Point& query : queries)
    for (const NearestLimits& limits : {NearestLimits{}, some}) {
      TraversalStats work;
      check(nearest(tree, query, limits, reader, work));
      if (work.nodes + work.blocks > tree.record_count) std::abort();
    }
  if (LinkFormat::is_leaf(tree.root_link) || tree.shape.moments)
    for (const Point& query : queries) query_winding(tree, query, reader);
}

void decode_and_query(std::uint8_t choices, std::span<const std::byte> first,
                      std::span<const std::byte> second) {
  PageInfo info;
  info.page_bytes = (choices & kLargePages) != 0 ? 65536 : 4096;
  info.page_count = (choices & kRootIsBlock) != 0 ? 1 : kPageCount;
  info.shape = {(choices & kFloat64) != 0, (choices & kWideIds) != 0, (choices & kMoments) != 0,
                (choices & kNumbers) != 0 ? LinkTarget::kNumber : LinkTarget::kSlot};
  Frame root(info.page_bytes), other(info.page_bytes);
  if (!decode(first, info, root)) return;
  info.page_number = 1 + choices / 64;
  Pages pages{&root, decode(second, info, other) ? &other : nullptr};
  TreeInfo tree;
  tree.page_bytes = info.page_bytes;
  tree.shape = info.shape;
  tree.record_count = 1000;
  tree.box_lower = Point(-1, -1, -1);
  tree.box_upper = Point(1, 1, 1);
  tree.core_lower = tree.box_lower;
  tree.core_upper = tree.box_upper;
  const bool leaf = (choices & kRootIsBlock) != 0;
  tree.root_link = root_link_of(info.page_bytes, info.shape.links, 0, leaf ? 0 : 1);
  query_tree(tree, pages);
}

}  // namespace
}  // namespace planetree::octree

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 3) return 0;
  const std::span bytes(reinterpret_cast<const std::byte*>(data + 3), size - 3);
  const std::size_t first_bytes = std::min<std::size_t>(data[1] | data[2] << 8, bytes.size());
  planetree::octree::decode_and_query(data[0], bytes.first(first_bytes),
                                      bytes.subspan(first_bytes));
  return 0;
}
