#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "octree/mask/mask_lookup.h"
#include "octree/page/mask_streams.h"
#include "octree/page/page_decoder.h"
#include "tests/fuzz/fuzz_frame.h"

/// Decodes arbitrary bytes as pages of a small mask and looks points up in it. Input by offset:
///
///   0  format of planes and page size, see kFloat64 and kLargePages
///   1  length of the first page, 2 bytes, little-endian
///   3  the mask's first page, then one that serves as every other page
///
/// The page number and key are set to the expected ones, because few inputs would pass that
/// comparison.
namespace planetree::octree {
namespace {

constexpr std::uint8_t kFloat64 = 1;
constexpr std::uint8_t kLargePages = 4;
constexpr std::uint32_t kFirstPage = 3;
constexpr std::uint32_t kPageCount = 64;

struct Pages {
  Frame* first;
  Frame* other;  // null if it does not decode
};

bool decode(std::span<const std::byte> bytes, PageInfo info, Frame& frame) {
  std::vector<std::byte> raw(bytes.begin(), bytes.end());
  MaskPageHead head{};
  const std::size_t head_bytes = std::min(raw.size(), sizeof head);
  std::copy_n(raw.begin(), head_bytes, reinterpret_cast<std::byte*>(&head));
  head.page_number = info.page_number;
  std::copy_n(reinterpret_cast<const std::byte*>(&head), head_bytes, raw.begin());
  info.octcode = head.octcode;
  return static_cast<bool>(decode_mask_page(raw, info, frame.bytes()));
}

void check(const MaskBlocks& blocks, const LinkFormat& links, std::uint32_t max_blocks) {
  if (blocks.count > kMaxListed) std::abort();
  if (blocks.count > 0 &&
      (!blocks.slab.direction_is_valid() || blocks.slab.lower > blocks.slab.upper))
    std::abort();
  for (unsigned i = 0; i < blocks.count; ++i) {
    const std::uint32_t link = blocks.links[i];
    if (!LinkFormat::is_leaf(link) || links.page(link) >= kFirstPage ||
        links.record(link) >= max_blocks)
      std::abort();
    if (i > 0 && blocks.links[i - 1] >= link) std::abort();
    if (blocks.octants[i] == 0) std::abort();
  }
}

void check(const MaskLookup& found, const Point& point, const MaskInfo& mask) {
  using Kind = MaskLookup::Kind;
  const auto fits = [](int number) { return -128 < number && number < 128; };
  if (!fits(found.winding) || found.cell.level > kLevels) std::abort();
  if (found.kind == Kind::kColour && std::abs(found.winding) > 1) std::abort();
  if (found.kind == Kind::kCorners &&
      !std::all_of(found.corners.begin(), found.corners.end(), fits))
    std::abort();
  if (found.on_surface && found.kind != Kind::kPlanes) std::abort();
  check(found.blocks, LinkFormat::numbered(mask.page_bytes), max_page_blocks(mask.page_bytes));
  if (found.blocks.count > 0 && (found.kind != Kind::kCorners || found.cell.level == kLevels))
    std::abort();
  const CellGrid grid(mask.lower);
  const Point upper = mask.lower + Point(2, 2, 2);
  const bool in_root =
      (point.array() >= mask.lower.array()).all() && (point.array() <= upper.array()).all();
  if (in_root && ((point.array() < grid.lower(found.cell).array()).any() ||
                  (point.array() > grid.upper(found.cell).array()).any()))
    std::abort();
}

void look_up_points(const MaskInfo& mask, Pages& pages) {
  const PageReader reader{&pages,
                          [](void* context, std::uint32_t page) noexcept -> const std::byte* {
                            const auto& both = *static_cast<Pages*>(context);
                            if (page < kFirstPage || page >= kFirstPage + kPageCount) std::abort();
                            Frame* frame = page == kFirstPage ? both.first : both.other;
                            return frame ? frame->bytes().data() : nullptr;
                          }};
  std::vector<Point> points = {{-1, -1, -1}, {1, 1, 1}, {0, 0, 0}, {-3, 0, 1e9}, {1e90, 0, 0}};
  std::uint32_t state = 1;
  const auto step = [&state] {
    state = state * 1664525 + 1013904223;
    return (state >> 8) * 0x1p-23 - 1;
  };
  for (int i = 0; i < 60; ++i) points.emplace_back(step(), step(), step());
  for (const Point& point : points)
    for (const std::uint64_t max_work : {std::uint64_t{1000}, std::uint64_t{2}}) {
      TraversalStats work;
      check(look_up(mask, point, max_work, reader, work), point, mask);
      if (work.nodes > std::min<std::uint64_t>(max_work, kLevels)) std::abort();
      if (work.page_switches > kLevels + 1) std::abort();
    }
}

void decode_and_look_up(std::uint8_t choices, std::span<const std::byte> first,
                        std::span<const std::byte> second) {
  PageInfo info;
  info.page_bytes = (choices & kLargePages) != 0 ? 65536 : 4096;
  info.first_page = info.tree_pages = kFirstPage;
  info.page_count = kPageCount;
  info.shape.float64 = (choices & kFloat64) != 0;
  info.page_number = kFirstPage;
  Frame root(info.page_bytes), other(info.page_bytes);
  if (!decode(first, info, root)) return;
  info.page_number += 1 + choices / 16;
  Pages pages{&root, decode(second, info, other) ? &other : nullptr};
  look_up_points({info.page_bytes, kFirstPage, kPageCount, Point(-1, -1, -1)}, pages);
}

}  // namespace
}  // namespace planetree::octree

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 3) return 0;
  const std::span bytes(reinterpret_cast<const std::byte*>(data + 3), size - 3);
  const std::size_t first_bytes = std::min<std::size_t>(data[1] | data[2] << 8, bytes.size());
  planetree::octree::decode_and_look_up(data[0], bytes.first(first_bytes),
                                        bytes.subspan(first_bytes));
  return 0;
}
