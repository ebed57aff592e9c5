#include "tests/fuzz/stream_page.h"

#include <algorithm>
#include <cstring>

#include "octree/page/mask_streams.h"
#include "octree/page/page_streams.h"

namespace planetree::octree {
namespace {

constexpr std::size_t kFirstCount = 16;

// Counts of a distance page, by index.
enum : std::uint8_t {
  kNodes,
  kBlocks,
  kRootNodes,
  kChildren,
  kPageLinks,
  kVertices,
  kVertexRefs,
  kTriangles,
  kFurtherTriangles,  // not in the head: triangles that are not the first of a block
  kCornerBytes,       // not in the head: follows from the blocks' counts
};
// Counts of a mask page, by index.
enum : std::uint8_t {
  kRecords,
  kRoots,
  kMaskNodes,
  kMaskPageLinks,
  kPlainCorners,
  kCornerLeaves,
  kSpecials,
  kPlanes,
  kListed,
  kBlockLinks,
};
// Indices of streams that count something.
enum : std::uint8_t { kKindStream = 0, kChildCountStream = 1, kChildKindStream = 3 };

std::vector<PageStream> distance_streams(const BlockShape& shape) {
  const unsigned coordinate = shape.float64 ? 8 : 4, index = shape.wide_ids ? 8 : 4;
  std::vector<PageStream> streams = {{4, kRootNodes, 6, false, {}}, {1, kNodes, 1, false, {}},
                                     {1, kNodes, 1, false, {}},     {2, kNodes, 1, false, {}},
                                     {1, kChildren, 6, true, {}},   {2, kChildren, 2, true, {}},
                                     {2, kChildren, 2, true, {}},   {2, kChildren, 1, true, {}}};
  if (shape.moments) {
    streams.push_back({2, kChildren, 3, true, {}});
    streams.push_back({1, kChildren, 5, true, {}});
    streams.push_back({2, kChildren, 1, true, {}});
    streams.push_back({2, kChildren, 1, true, {}});
  }
  const PageStream others[] = {
      {4, kPageLinks, 1, false, {}},   {2, kPageLinks, 1, false, {}},
      {1, kBlocks, 1, false, {}},      {1, kBlocks, 1, false, {}},
      {1, kBlocks, 1, false, {}},      {2, kVertexRefs, 1, false, {}},
      {1, kCornerBytes, 1, false, {}}, {coordinate, kVertices, 3, false, {}},
      {index, kBlocks, 1, false, {}},  {index, kFurtherTriangles, 1, false, {}}};
  streams.insert(streams.end(), std::begin(others), std::end(others));
  return streams;
}

std::vector<PageStream> mask_streams(const BlockShape& shape) {
  const unsigned coordinate = shape.float64 ? 8 : 4;
  return {{1, kRecords, 1, false, {}},         {1, kMaskNodes, 1, false, {}},
          {1, kMaskNodes, 1, false, {}},       {1, kMaskNodes, 1, false, {}},
          {1, kMaskNodes, 1, false, {}},       {4, kMaskPageLinks, 1, false, {}},
          {2, kMaskPageLinks, 1, false, {}},   {1, kPlainCorners, 1, false, {}},
          {1, kCornerLeaves, 8, false, {}},    {1, kSpecials, 1, false, {}},
          {1, kSpecials, 1, false, {}},        {1, kSpecials, 1, false, {}},
          {coordinate, kPlanes, 9, false, {}}, {1, kListed, 1, false, {}},
          {1, kListed, 1, false, {}},          {1, kListed, 1, false, {}},
          {2, kListed, 1, false, {}},          {1, kListed, 1, false, {}},
          {1, kListed, 1, false, {}},          {1, kBlockLinks, 1, false, {}},
          {4, kBlockLinks, 1, false, {}},      {2, kBlockLinks, 1, false, {}}};
}

}  // namespace

void PageStream::resize(std::size_t elements) {
  while (size() < elements && size() > 0) repeat(size() - 1);
  bytes.resize(elements * width);
}

void PageStream::repeat(std::size_t first, std::size_t elements) {
  const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(first * width);
  const std::vector<std::byte> copy(at, at + static_cast<std::ptrdiff_t>(elements * width));
  bytes.insert(at, copy.begin(), copy.end());
}

void PageStream::erase(std::size_t first, std::size_t elements) {
  const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(first * width);
  bytes.erase(at, at + static_cast<std::ptrdiff_t>(elements * width));
}

std::optional<StreamPage> StreamPage::of(std::span<const std::byte> raw, bool is_mask,
                                         const BlockShape& shape) {
  if (raw.size() < kHeadBytes || raw.size() > kMaxBytes) return {};
  StreamPage page;
  page.is_mask_ = is_mask;
  page.shape_ = shape;
  std::copy_n(raw.begin(), kHeadBytes, page.head_.begin());
  page.streams_ = is_mask ? mask_streams(shape) : distance_streams(shape);
  raw = raw.subspan(kHeadBytes);
  for (std::size_t i = 0; i < page.streams_.size(); ++i) {
    PageStream& stream = page.streams_[i];
    const std::size_t elements = page.elements_of(i), length = elements * stream.width;
    if (length > raw.size()) return {};
    stream.bytes.resize(length);
    for (std::size_t at = 0; at < length; ++at)
      stream.bytes[at % elements * stream.width + at / elements] = raw[at];
    raw = raw.subspan(length);
  }
  page.rest_.assign(raw.begin(), raw.end());
  return page;
}

std::vector<std::byte> StreamPage::bytes() const {
  std::vector<std::byte> raw(head_.begin(), head_.end());
  for (const PageStream& stream : streams_)
    for (std::size_t k = 0; k < stream.width; ++k)
      for (std::size_t i = 0; i < stream.size(); ++i)
        raw.push_back(stream.bytes[i * stream.width + k]);
  raw.insert(raw.end(), rest_.begin(), rest_.end());
  return raw;
}

std::size_t StreamPage::linked_pages() const { return is_mask_ ? 5 : shape_.moments ? 12 : 8; }

std::uint16_t StreamPage::count(std::size_t index) const {
  std::uint16_t value = 0;
  std::memcpy(&value, head_.data() + kFirstCount + 2 * index, sizeof value);
  return value;
}

void StreamPage::set_count(std::size_t index, std::size_t value) {
  const auto stored = static_cast<std::uint16_t>(value);
  std::memcpy(head_.data() + kFirstCount + 2 * index, &stored, sizeof stored);
}

template <class Change>
void StreamPage::change_records(std::size_t count_index, std::size_t record, Change change) {
  for (PageStream& stream : streams_) {
    if (stream.count != count_index) continue;
    const std::size_t records = stream.size() / stream.per_record;
    if (record >= records) continue;
    if (!stream.by_plane) change(stream, record * stream.per_record, stream.per_record);
    for (std::size_t k = stream.by_plane ? stream.per_record : 0; k-- > 0;)
      change(stream, k * records + record, 1);
  }
}

void StreamPage::repeat_record(std::size_t count_index, std::size_t record) {
  change_records(count_index, record, [](PageStream& stream, std::size_t at, std::size_t count) {
    stream.repeat(at, count);
  });
  set_count(count_index, count(count_index) + std::size_t{1});
}

void StreamPage::erase_record(std::size_t count_index, std::size_t record) {
  if (count(count_index) == 0) return;
  change_records(count_index, record, [](PageStream& stream, std::size_t at, std::size_t count) {
    stream.erase(at, count);
  });
  set_count(count_index, count(count_index) - std::size_t{1});
}

void StreamPage::fit_head() { is_mask_ ? fit_mask_head() : fit_distance_head(); }

void StreamPage::fit_streams() {
  for (std::size_t i = 0; i < streams_.size(); ++i) streams_[i].resize(elements_of(i));
  rest_.clear();
}

std::size_t StreamPage::elements_of(std::size_t stream) const {
  const PageStream& it = streams_[stream];
  if (!is_mask_ && it.count == kCornerBytes) return corner_stream_bytes();
  if (!is_mask_ && it.count == kFurtherTriangles)
    return std::max(count(kTriangles), count(kBlocks)) - std::size_t{count(kBlocks)};
  return std::size_t{it.per_record} * count(it.count);
}

std::size_t StreamPage::sum(std::size_t stream, unsigned mask) const {
  std::size_t sum = 0;
  for (const std::byte value : streams_[stream].bytes)
    sum += std::to_integer<unsigned>(value) & mask;
  return sum;
}

std::size_t StreamPage::corner_stream_bytes() const {
  const PageStream& triangles = streams_[linked_pages() + 2];
  const PageStream& vertices = streams_[linked_pages() + 3];
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < triangles.size() && i < vertices.size(); ++i)
    bytes += corner_bytes(std::to_integer<unsigned>(triangles.bytes[i]) & kCountBits,
                          std::to_integer<unsigned>(vertices.bytes[i]));
  return bytes;
}

void StreamPage::fit_distance_head() {
  const std::size_t blocks = linked_pages() + 2;
  set_count(kChildren, sum(kChildCountStream));
  std::size_t links = 0;
  PageStream& kinds = streams_[kChildKindStream];
  for (std::size_t node = 0; node < kinds.size(); ++node) {
    std::uint16_t packed = 0;
    std::memcpy(&packed, kinds.element(node).data(), sizeof packed);
    const auto children = std::to_integer<unsigned>(streams_[kChildCountStream].bytes[node]);
    for (unsigned child = 0; child < std::min(children, 8U); ++child)
      links += (packed >> 2 * child & 3U) == static_cast<unsigned>(ChildKind::kPage);
  }
  set_count(kPageLinks, links);
  set_count(kTriangles, sum(blocks, kCountBits));
  const std::size_t vertices = sum(blocks + 1), fresh = sum(blocks + 2);
  set_count(kVertices, fresh);
  set_count(kVertexRefs, std::max(vertices, fresh) - fresh);
}

void StreamPage::fit_mask_head() {
  std::array<std::size_t, 6> records{};
  for (const std::byte kind : streams_[kKindStream].bytes)
    if (std::to_integer<std::size_t>(kind) < records.size())
      ++records[std::to_integer<std::size_t>(kind)];
  set_count(kMaskNodes, records[0] + records[1]);
  set_count(kMaskPageLinks, records[1]);
  set_count(kPlainCorners, records[2]);
  set_count(kCornerLeaves, records[3]);
  set_count(kSpecials, records[4]);
  set_count(kListed, records[5]);
  set_count(kPlanes, sum(9));
  set_count(kBlockLinks, sum(15));
}

}  // namespace planetree::octree
