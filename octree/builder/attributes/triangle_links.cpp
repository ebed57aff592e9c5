#include "octree/builder/attributes/triangle_links.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>

#include "octree/attributes/attribute_page.h"
#include "octree/page/page_streams.h"

namespace planetree::octree {
namespace {

// As many pages as PageAppender makes at a time.
constexpr std::uint32_t kMinBucketPages = 256;
constexpr std::uint64_t kMaxBuckets = 4096;
constexpr std::uint64_t kBufferBytes = std::uint64_t{8} << 20;

// An index within its bucket, and the link of the block that has it.
struct Place {
  std::uint32_t index;
  std::uint32_t link;
};
static_assert(sizeof(Place) == TriangleLinks::kTriangleBytes);

std::uint32_t bucket_pages(std::uint64_t index_count, std::uint32_t in_page) {
  const std::uint64_t pages = (index_count - 1) / in_page + 1;
  return std::max(kMinBucketPages, static_cast<std::uint32_t>((pages - 1) / kMaxBuckets + 1));
}

}  // namespace

TriangleLinks::TriangleLinks(std::uint64_t index_count, std::uint32_t in_page,
                             const BlockShape& shape, std::uint32_t page_bytes,
                             storage::SpillFile& file)
    : index_count_(index_count),
      shape_(shape),
      format_(LinkFormat::numbered(page_bytes)),
      pages_per_bucket_(bucket_pages(index_count, in_page)),
      bucket_indices_(std::uint64_t{pages_per_bucket_} * in_page),
      buckets_(sizeof(Place), static_cast<std::size_t>((index_count - 1) / bucket_indices_ + 1),
               kBufferBytes, file) {}

Result<void> TriangleLinks::add(std::uint32_t number, std::span<const std::byte> raw) {
  RawStreams streams;
  [[maybe_unused]] const char* const fault = streams.read(raw, shape_);
  assert(fault == nullptr);
  const PageHead& head = streams.head;
  std::size_t next_step = 0;
  const std::lock_guard one(adding_);
  for (std::uint16_t block = 0; block < head.block_count; ++block) {
    std::array<std::uint64_t, kMaxBlockTriangles> indices;
    const std::size_t count = streams.triangle_count(block);
    indices[0] = shape_.wide_ids ? streams.first_ids64[block] : streams.first_ids32[block];
    for (std::size_t i = 1; i < count; ++i, ++next_step)
      indices[i] = indices[i - 1] + (shape_.wide_ids ? streams.id_steps64[next_step]
                                                     : streams.id_steps32[next_step]);
    const std::uint32_t link = format_.make_block({number, block});
    const auto added = add_block(link, std::span(indices).first(count));
    if (!added) return added;
  }
  return {};
}

Result<void> TriangleLinks::add_block(std::uint32_t link, std::span<const std::uint64_t> indices) {
  for (const std::uint64_t index : indices) {
    assert(index < index_count_);
    const Place place{static_cast<std::uint32_t>(index % bucket_indices_), link};
    std::byte* const to = buckets_.add(static_cast<std::size_t>(index / bucket_indices_));
    if (!to) return buckets_.failure();
    std::memcpy(to, &place, sizeof place);
  }
  return {};
}

Result<std::vector<std::uint32_t>> TriangleLinks::links(std::uint32_t bucket) {
  const std::uint64_t first = bucket * bucket_indices_;
  std::vector<std::uint32_t> links(
      static_cast<std::size_t>(std::min(bucket_indices_, index_count_ - first)), kNoLink);
  const auto read = buckets_.each_block(bucket, [&](std::span<const std::byte> records) {
    for (; !records.empty(); records = records.subspan(sizeof(Place))) {
      Place place;
      std::memcpy(&place, records.data(), sizeof place);
      links[place.index] = place.link;
    }
    return Result<void>();
  });
  if (!read) return read.error();
  return links;
}

}  // namespace planetree::octree
