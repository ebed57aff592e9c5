#include "octree/page/block_decoder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "octree/page/block_unpacking.h"

namespace planetree::octree {
namespace {

// Returns an upper bound on the distance whose square is `square`, in float. Where the square has
// underflowed the result may be too small, but it is then below kFilterMinExtent and not used.
float extent_of(float square) { return std::sqrt(square) * kExtentInflation + kMinFloatNormal; }

}  // namespace

const char* BlockDecoder::start(std::byte* records) noexcept {
  const PageHead& head = streams_.head;
  block_ = head.block_count;
  std::size_t vertices = 0;
  for (std::size_t i = 0; i < block_; ++i) {
    vertices += streams_.vertex_counts[i];
    new_vertices_ += streams_.new_counts[i];
  }
  refs_ = streams_.vertex_refs.size();
  if (new_vertices_ != head.vertex_count || vertices - new_vertices_ != refs_)
    return "its vertices do not add up";
  corner_bytes_ = streams_.corners.size();
  id_steps_ = std::size_t{head.triangle_count} - head.block_count;
  vertices_ = records;
  const bool good = shape_.float64
                        ? unpack_vertices(streams_.vertices64, reinterpret_cast<double*>(records))
                        : unpack_vertices(streams_.vertices32, reinterpret_cast<float*>(records));
  return good ? nullptr : "a vertex is out of range";
}

const char* BlockDecoder::decode_last(std::byte* record) noexcept {
  --block_;
  // Prefetches the lines of a record that will be written soon, if enough records precede this one.
  // Written out here, because the compiler drops calls to a function without visible effect.
  constexpr unsigned kAhead = 14, kLines = 7;
  if (record - vertices_ >= std::ptrdiff_t{(kAhead + kLines) * kSlotBytes})
    for (unsigned line = 1; line <= kLines; ++line)
      __builtin_prefetch(record - (kAhead + line) * kSlotBytes, 1);
  BlockHeader header{};
  header.triangle_count = streams_.triangle_count(block_);
  header.form = streams_.vertex_counts[block_];
  if (streams_.is_height_field(block_)) header.form |= BlockHeader::kHeightField;
  if (streams_.compact(block_)) header.form |= BlockHeader::kCompact;
  VertexIndices indices;
  if (const char* fault = find_vertices(header, indices)) return fault;
  if (const char* fault = store_corners(header)) return fault;
  if (shape_.float64)
    store_float64_vertices(header, indices, record);
  else
    store_vertices(header, indices, record);
  if (const char* fault = store_ids(header, record)) return fault;
  std::memcpy(record, &header, sizeof header);
  return nullptr;
}

const char* BlockDecoder::find_vertices(const BlockHeader& header, VertexIndices& indices) {
  const unsigned new_count = streams_.new_counts[block_];
  const unsigned old_count = header.vertex_count() - new_count;
  new_vertices_ -= new_count;
  refs_ -= old_count;
  const BlockVertices block{refs_, old_count, new_vertices_, header.vertex_count()};
  return unpack_indices(streams_.vertex_refs, block, header.stride(), indices.data())
             ? nullptr
             : "a block names a vertex twice, or one the page has not had";
}

const char* BlockDecoder::store_corners(BlockHeader& header) {
  corner_bytes_ -= corner_bytes(header.triangle_count, header.vertex_count());
  const auto stored = streams_.corners.subspan(corner_bytes_);
  BlockCorners corners;
  if (!unpack_corners(stored, header.triangle_count, header.vertex_count(), corners))
    return "a corner names a vertex its block has not";
  if (header.compact())
    std::memcpy(header.packed_corners, corners.packed, sizeof corners.packed);
  else
    for (std::size_t k = 0; k < 3; ++k)
      std::memcpy(header.corner_row(k), corners.row[k], sizeof corners.row[k]);
  const std::size_t bits =
      std::size_t{3} * header.triangle_count * corner_bits(header.vertex_count());
  if (bits % 8 != 0 && std::to_integer<unsigned>(stored[bits / 8]) >> bits % 8 != 0)
    return "padding is not zero";
  return nullptr;
}

// A record that overlaps the vertices it is made from receives its rows only after all are read.
void BlockDecoder::store_vertices(BlockHeader& header, const VertexIndices& indices,
                                  std::byte* record) const {
  const auto* all = reinterpret_cast<const float*>(vertices_);
  auto* rows = reinterpret_cast<float*>(record + kSlotBytes);
  const std::size_t length = 3 * std::size_t{header.stride()};
  // unpack_rows() reads one float more.
  const float* end_read = all + 3 * (new_vertices_ + streams_.new_counts[block_]) + 1;
  if (end_read <= rows) {
    header.extent = extent_of(unpack_rows(all, indices.data(), header.stride(), rows));
  } else {
    std::array<float, 3 * kMaxBlockVertices> apart;
    header.extent = extent_of(unpack_rows(all, indices.data(), header.stride(), apart.data()));
    std::copy_n(apart.data(), length, rows);
  }
}

void BlockDecoder::store_float64_vertices(BlockHeader& header, const VertexIndices& indices,
                                          std::byte* record) const {
  const auto* all = reinterpret_cast<const double*>(vertices_);
  const unsigned stride = header.stride();
  std::array<double, 3 * kMaxBlockVertices> exact;
  std::array<float, 3 * kMaxBlockVertices + 1> local{};
  for (unsigned i = 0; i < stride; ++i)
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double value = all[3 * std::size_t{indices[i]} + axis];
      exact[axis * stride + i] = value;
      local[3 * i + axis] = static_cast<float>(value - exact[axis * stride]);
    }
  VertexIndices consecutive;
  std::iota(consecutive.begin(), consecutive.end(), std::uint16_t{0});
  auto* rows = reinterpret_cast<float*>(record + kSlotBytes);
  header.extent = extent_of(unpack_rows(local.data(), consecutive.data(), stride, rows));
  std::memcpy(record + shape_.exact_offset(stride), exact.data(), 3 * stride * sizeof(double));
}

const char* BlockDecoder::store_ids(BlockHeader& header, std::byte* record) {
  constexpr const char* kNotAscending = "triangle indices do not ascend";
  const unsigned count = header.triangle_count;
  id_steps_ -= count - 1;
  if (shape_.wide_ids) {
    auto* ids = reinterpret_cast<std::uint64_t*>(record + shape_.id_offset(header.stride()));
    const bool ascend =
        unpack_ids(streams_.first_ids64[block_], streams_.id_steps64, id_steps_, count, ids);
    return ascend ? nullptr : kNotAscending;
  }
  std::uint32_t ids[kMaxBlockTriangles];
  if (!unpack_ids(streams_.first_ids32[block_], streams_.id_steps32, id_steps_, count, ids))
    return kNotAscending;
  if (header.compact() != shape_.is_compact(header.vertex_count(), ids[count - 1] - ids[0]))
    return "a block is not as compact as its indices are";
  if (!header.compact()) {
    std::memcpy(record + shape_.id_offset(header.stride()), ids, sizeof ids);
    return nullptr;
  }
  header.first_id = ids[0];
  for (unsigned i = 1; i < kMaxBlockTriangles; ++i)
    header.id_step[i - 1] = static_cast<std::uint16_t>(ids[i] - ids[0]);
  return nullptr;
}

}  // namespace planetree::octree
