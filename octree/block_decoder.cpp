#include "octree/block_decoder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

#include "octree/strict_math.h"

namespace planetree::octree {
namespace {

// An honest model's coordinates are below 2^55. Up to here no square and no
// product of squares overflows, wherever vertices go from here.
constexpr double kFarthestVertex = 0x1p60;

// Eight bytes from one on, those past the end 0; the first is the lowest.
std::uint64_t word_at(std::span<const std::byte> bytes, std::size_t first) {
  std::uint64_t word = 0;
  if (bytes.size() - first >= sizeof word)
    std::memcpy(&word, bytes.data() + first, sizeof word);
  else
    std::memcpy(&word, bytes.data() + first, bytes.size() - first);
  return word;
}

// At least the distance of any vertex from the first.
float extent_of(const float* rows, unsigned count, unsigned stride) {
  float squared = 0;
  for (unsigned i = 0; i < count; ++i) {
    const float x = rows[i] - rows[0], y = rows[stride + i] - rows[stride],
                z = rows[2 * stride + i] - rows[2 * stride];
    squared = std::max(squared, x * x + y * y + z * z);
  }
  return std::sqrt(squared) * (1 + 0x1p-20f) + std::numeric_limits<float>::min();
}

}  // namespace

const char* BlockDecoder::decode_next(std::byte* record) noexcept {
  auto& header = *reinterpret_cast<BlockHeader*>(record);
  header = BlockHeader{};
  header.triangle_count = streams_.triangle_count(block_);
  header.vertex_count = streams_.vertex_counts[block_];
  header.stride = static_cast<std::uint8_t>(BlockShape::stride(header.vertex_count));
  header.in_sheet = streams_.in_sheet(block_) ? 1 : 0;
  Vertices vertices;
  if (const char* fault =
          collect_vertices(header.vertex_count, streams_.new_counts[block_], vertices))
    return fault;
  if (const char* fault = store_corners(header)) return fault;
  if (const char* fault = store_vertices(header, vertices)) return fault;
  if (const char* fault = store_ids(header)) return fault;
  ++block_;
  return nullptr;
}

const char* BlockDecoder::finish() const noexcept {
  return next_ref_ == streams_.vertex_refs.size() && next_vertex_ == streams_.head.vertex_count
             ? nullptr
             : "its vertices do not add up";
}

const char* BlockDecoder::collect_vertices(unsigned count, unsigned new_count, Vertices& vertices) {
  vertices.old_count = count - new_count;
  if (vertices.old_count > streams_.vertex_refs.size() - next_ref_ ||
      new_count > streams_.head.vertex_count - next_vertex_)
    return "its vertices do not add up";
  std::uint32_t vertex = 0;
  for (unsigned i = 0; i < vertices.old_count; ++i) {
    const std::uint32_t step = streams_.vertex_refs[next_ref_++];
    if (i > 0 && step == 0) return "a block names a vertex twice";
    vertex += step;
    if (vertex >= next_vertex_) return "a block names a vertex the page has not had";
    vertices.old[i] = vertex;
  }
  vertices.first_new = next_vertex_;
  next_vertex_ += new_count;
  return nullptr;
}

const char* BlockDecoder::store_corners(BlockHeader& header) {
  const unsigned bits = corner_bits(header.vertex_count), mask = (1u << bits) - 1;
  const auto bytes = streams_.corners.subspan(
      next_corner_byte_, corner_bytes(header.triangle_count, header.vertex_count));
  next_corner_byte_ += bytes.size();
  // Whole triangles, with at most 7 bits before them.
  const unsigned at_once = 57 / (3 * bits);
  std::size_t next_bit = 0;
  unsigned greatest = 0;
  for (unsigned first = 0; first < header.triangle_count; first += at_once) {
    std::uint64_t window = word_at(bytes, next_bit / 8) >> next_bit % 8;
    const unsigned end = std::min(first + at_once, unsigned{header.triangle_count});
    next_bit += std::size_t{3} * bits * (end - first);
    for (unsigned triangle = first; triangle < end; ++triangle)
      for (auto& corners : header.corner) {
        const auto vertex = static_cast<unsigned>(window) & mask;
        window >>= bits;
        greatest = std::max(greatest, vertex);
        corners[triangle] = static_cast<std::uint8_t>(vertex);
      }
  }
  if (greatest >= header.vertex_count) return "a corner names a vertex its block has not";
  if (next_bit % 8 != 0 && std::to_integer<unsigned>(bytes.back()) >> next_bit % 8 != 0)
    return "padding is not zero";
  // Lanes beyond the last triangle repeat it, so that kernels need no mask.
  for (auto& corners : header.corner)
    std::fill(corners + header.triangle_count, corners + kMaxBlockTriangles,
              corners[header.triangle_count - 1]);
  return nullptr;
}

const char* BlockDecoder::store_vertices(BlockHeader& header, const Vertices& vertices) {
  constexpr const char* kOutOfRange = "a vertex is out of range";
  const unsigned count = header.vertex_count, stride = header.stride;
  auto* record = reinterpret_cast<std::byte*>(&header);
  auto* local = reinterpret_cast<float*>(record + kSlotBytes);
  if (shape_.float64) {
    auto* exact = reinterpret_cast<double*>(record + shape_.exact_offset(stride));
    if (!store_rows(streams_.vertices64, vertices, count, stride, exact)) return kOutOfRange;
    for (unsigned first = 0; first < 3 * stride; first += stride)
      for (unsigned i = first; i < first + stride; ++i)
        local[i] = static_cast<float>(exact[i] - exact[first]);
  } else if (!store_rows(streams_.vertices32, vertices, count, stride, local)) {
    return kOutOfRange;
  }
  header.extent = extent_of(local, count, stride);
  return nullptr;
}

// A row of each coordinate, with the first vertex again up to the stride. False where one is out
// of range.
template <class T>
bool BlockDecoder::store_rows(const Shuffled<T>& page, const Vertices& vertices, unsigned count,
                              unsigned stride, T* rows) {
  const std::size_t per_axis = page.size() / 3;
  bool good = true;
  for (std::size_t axis = 0; axis < 3; ++axis, rows += stride) {
    const std::size_t first = axis * per_axis;
    for (unsigned i = 0; i < vertices.old_count; ++i) rows[i] = page[first + vertices.old[i]];
    const std::size_t first_new = first + vertices.first_new - vertices.old_count;
    for (unsigned i = vertices.old_count; i < count; ++i) rows[i] = page[first_new + i];
    for (unsigned i = 0; i < count; ++i) good &= std::fabs(rows[i]) <= T{kFarthestVertex};
    std::fill(rows + count, rows + stride, rows[0]);
  }
  return good;
}

const char* BlockDecoder::store_ids(BlockHeader& header) {
  auto* ids = reinterpret_cast<std::byte*>(&header) + shape_.id_offset(header.stride);
  const bool ascend = shape_.wide_ids
                          ? store_ids(streams_.first_ids64, streams_.id_steps64,
                                      header.triangle_count, reinterpret_cast<std::uint64_t*>(ids))
                          : store_ids(streams_.first_ids32, streams_.id_steps32,
                                      header.triangle_count, reinterpret_cast<std::uint32_t*>(ids));
  return ascend ? nullptr : "triangle indices do not ascend";
}

template <class Id>
bool BlockDecoder::store_ids(const Shuffled<Id>& firsts, const Shuffled<Id>& steps, unsigned count,
                             Id* ids) {
  Id id = firsts[block_];
  ids[0] = id;
  bool ascend = true;
  for (unsigned i = 1; i < count; ++i) {
    const Id last = id;
    id = static_cast<Id>(id + steps[next_id_step_++]);
    ascend &= id > last;  // nor does a sum that overflows
    ids[i] = id;
  }
  std::fill(ids + count, ids + kMaxBlockTriangles, id);
  return ascend;
}

}  // namespace planetree::octree
