#include "octree/block_decoder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/strict_math.h"

namespace planetree::octree {
namespace {

// Bits, lowest first, from a stream of bytes.
class BitReader {
 public:
  explicit BitReader(const std::byte* bytes) : next_(bytes) {}
  unsigned take(unsigned bits) {
    while (held_ < bits) {
      window_ |= static_cast<unsigned>(*next_++) << held_;
      held_ += 8;
    }
    const unsigned value = window_ & ((1u << bits) - 1);
    window_ >>= bits;
    held_ -= bits;
    return value;
  }
  unsigned rest() const { return window_; }

 private:
  const std::byte* next_;
  unsigned window_ = 0;
  unsigned held_ = 0;
};

// An honest model's coordinates are below 2^55. Up to here no square and no
// product of squares overflows, wherever vertices go from here.
constexpr double kFarthestVertex = 0x1p60;

bool in_range(double coordinate) { return std::fabs(coordinate) <= kFarthestVertex; }

float distance_up(float x, float y, float z) {
  return std::sqrt(x * x + y * y + z * z) * (1 + 0x1p-20f) + std::numeric_limits<float>::min();
}

}  // namespace

const char* BlockDecoder::decode_next(std::byte* record) noexcept {
  auto& header = *reinterpret_cast<BlockHeader*>(record);
  header = BlockHeader{};
  header.triangle_count = streams_.triangle_counts[block_];
  header.vertex_count = streams_.vertex_counts[block_];
  header.stride = static_cast<std::uint8_t>(BlockShape::stride(header.vertex_count));
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

// Vertices that the page has had come first, ascending; then new ones in order.
const char* BlockDecoder::collect_vertices(unsigned count, unsigned new_count, Vertices& vertices) {
  const unsigned old_count = count - new_count;
  if (old_count > streams_.vertex_refs.size() - next_ref_ ||
      new_count > streams_.head.vertex_count - next_vertex_)
    return "its vertices do not add up";
  std::uint32_t vertex = 0;
  for (unsigned i = 0; i < old_count; ++i) {
    const std::uint32_t step = streams_.vertex_refs[next_ref_++];
    if (i > 0 && step == 0) return "a block names a vertex twice";
    vertex += step;
    if (vertex >= next_vertex_) return "a block names a vertex the page has not had";
    vertices[i] = vertex;
  }
  for (unsigned i = old_count; i < count; ++i)
    vertices[i] = static_cast<std::uint32_t>(next_vertex_++);
  return nullptr;
}

const char* BlockDecoder::store_corners(BlockHeader& header) {
  const unsigned bits = corner_bits(header.vertex_count);
  BitReader reader(streams_.corners.data() + next_corner_byte_);
  for (unsigned triangle = 0; triangle < header.triangle_count; ++triangle)
    for (auto& corners : header.corner) {
      const unsigned vertex = reader.take(bits);
      if (vertex >= header.vertex_count) return "a corner names a vertex its block has not";
      corners[triangle] = static_cast<std::uint8_t>(vertex);
    }
  if (reader.rest() != 0) return "padding is not zero";
  next_corner_byte_ += corner_bytes(header.triangle_count, header.vertex_count);
  // Lanes beyond the last triangle repeat it, so that kernels need no mask.
  for (auto& corners : header.corner)
    std::fill(corners + header.triangle_count, corners + kMaxBlockTriangles,
              corners[header.triangle_count - 1]);
  return nullptr;
}

const char* BlockDecoder::store_vertices(BlockHeader& header, const Vertices& vertices) {
  constexpr const char* kOutOfRange = "a vertex is out of range";
  auto* record = reinterpret_cast<std::byte*>(&header);
  auto* local = reinterpret_cast<float*>(record + kSlotBytes);
  auto* exact = reinterpret_cast<double*>(record + shape_.exact_offset(header.stride));
  for (unsigned axis = 0; axis < 3; ++axis) {
    float* row = local + std::size_t{axis} * header.stride;
    double* exact_row = exact + std::size_t{axis} * header.stride;
    for (unsigned i = 0; i < header.vertex_count; ++i) {
      const std::size_t element = axis * std::size_t{streams_.head.vertex_count} + vertices[i];
      if (shape_.float64) {
        exact_row[i] = streams_.vertices64[element];
        if (!in_range(exact_row[i])) return kOutOfRange;
        row[i] = static_cast<float>(exact_row[i] - exact_row[0]);
      } else {
        row[i] = streams_.vertices32[element];
        if (!in_range(static_cast<double>(row[i]))) return kOutOfRange;
      }
    }
    std::fill(row + header.vertex_count, row + header.stride, row[0]);
    if (shape_.float64)
      std::fill(exact_row + header.vertex_count, exact_row + header.stride, exact_row[0]);
  }
  for (unsigned i = 0; i < header.vertex_count; ++i) {
    const unsigned stride = header.stride;
    header.extent =
        std::max(header.extent, distance_up(local[i] - local[0], local[stride + i] - local[stride],
                                            local[2 * stride + i] - local[2 * stride]));
  }
  return nullptr;
}

const char* BlockDecoder::store_ids(BlockHeader& header) {
  auto* ids = reinterpret_cast<std::byte*>(&header) + shape_.id_offset(header.stride);
  std::uint64_t id = shape_.wide_ids ? streams_.first_ids64[block_] : streams_.first_ids32[block_];
  const std::uint64_t limit = shape_.wide_ids ? ~std::uint64_t{0} : 0xffffffff;
  for (unsigned i = 0; i < kMaxBlockTriangles; ++i) {
    if (i > 0 && i < header.triangle_count) {
      const std::uint64_t step =
          shape_.wide_ids ? streams_.id_steps64[next_id_step_] : streams_.id_steps32[next_id_step_];
      ++next_id_step_;
      if (step == 0 || step > limit - id) return "triangle indices do not ascend";
      id += step;
    }
    if (shape_.wide_ids)
      reinterpret_cast<std::uint64_t*>(ids)[i] = id;
    else
      reinterpret_cast<std::uint32_t*>(ids)[i] = static_cast<std::uint32_t>(id);
  }
  return nullptr;
}

}  // namespace planetree::octree
