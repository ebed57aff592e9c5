#include "octree/block_unpacking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/block_unpacking.cpp"
#include <hwy/foreach_target.h>

#include "octree/page_streams.h"
#include "octree/strict_math.h"
#include "octree/wide_floats-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

using ByteTag = hn::FixedTag<std::uint8_t, 16>;
using PairTag = hn::Repartition<std::uint16_t, ByteTag>;
using QuadTag = hn::Repartition<std::uint32_t, ByteTag>;
using FourTag = hn::Repartition<float, ByteTag>;
using Four = hn::Vec<FourTag>;

// Sixteen floats of a shuffled array, from an index on.
HWY_INLINE void load_sixteen(const std::byte* shuffled, std::size_t count, std::size_t first,
                             Four (&floats)[4]) {
  const ByteTag bytes;
  const PairTag pairs;
  const QuadTag quads;
  const FourTag four;
  const auto plane = [&](std::size_t k) {
    return hn::LoadU(bytes, reinterpret_cast<const std::uint8_t*>(shuffled) + k * count + first);
  };
  const auto b0 = plane(0), b1 = plane(1), b2 = plane(2), b3 = plane(3);
  const auto low0 = hn::BitCast(pairs, hn::InterleaveLower(bytes, b0, b1));
  const auto low1 = hn::BitCast(pairs, hn::InterleaveUpper(bytes, b0, b1));
  const auto high0 = hn::BitCast(pairs, hn::InterleaveLower(bytes, b2, b3));
  const auto high1 = hn::BitCast(pairs, hn::InterleaveUpper(bytes, b2, b3));
  const auto join = [&](auto quad) { return hn::BitCast(four, hn::BitCast(quads, quad)); };
  floats[0] = join(hn::InterleaveLower(pairs, low0, high0));
  floats[1] = join(hn::InterleaveUpper(pairs, low0, high0));
  floats[2] = join(hn::InterleaveLower(pairs, low1, high1));
  floats[3] = join(hn::InterleaveUpper(pairs, low1, high1));
}

// Of whole sixteens of the vertices; how many those are.
std::size_t vertices_on_target(const std::byte* shuffled, std::size_t vertex_count, float* vertices,
                               bool& good) {
  const FourTag four;
  const std::size_t whole = vertex_count / 16 * 16;
  auto greatest = hn::Zero(QuadTag());
  for (std::size_t first = 0; first < whole; first += 16) {
    Four x[4], y[4], z[4];
    load_sixteen(shuffled, 3 * vertex_count, first, x);
    load_sixteen(shuffled, 3 * vertex_count, first + vertex_count, y);
    load_sixteen(shuffled, 3 * vertex_count, first + 2 * vertex_count, z);
    for (std::size_t i = 0; i < 4; ++i) {
      hn::StoreInterleaved3(x[i], y[i], z[i], four, vertices + 3 * (first + 4 * i));
      // The bits of what is no number are greater than those of any.
      for (const Four& row : {x[i], y[i], z[i]})
        greatest = hn::Max(greatest, hn::BitCast(QuadTag(), hn::Abs(row)));
    }
  }
  const auto most = hn::BitCast(QuadTag(), hn::Set(four, static_cast<float>(kFarthestVertex)));
  good = hn::AllTrue(QuadTag(), hn::Eq(hn::Max(greatest, most), most));
  return whole;
}

#else

std::size_t vertices_on_target(const std::byte*, std::size_t, float*, bool&) { return 0; }

#endif

constexpr std::uint64_t low_bits(unsigned count) { return (std::uint64_t{1} << count) - 1; }

// Fields of so many bits, each to a byte of its own: eight from each word of as many bytes.
template <unsigned kBits>
HWY_INLINE void spread_fields(const std::byte* packed, std::uint8_t* fields) {
  constexpr std::uint64_t kHalf = low_bits(4 * kBits);
  constexpr std::uint64_t kQuarters = low_bits(2 * kBits) * 0x0000000100000001;
  constexpr std::uint64_t kEighths = low_bits(kBits) * 0x0001000100010001;
  for (unsigned first = 0; first < 3 * kMaxBlockTriangles; first += 8) {
    std::uint64_t word;
    std::memcpy(&word, packed + first / 8 * kBits, sizeof word);
    word = (word & kHalf) | (word >> 4 * kBits & kHalf) << 32;
    word = (word & kQuarters) | (word >> 2 * kBits & kQuarters) << 16;
    word = (word & kEighths) | (word >> kBits & kEighths) << 8;
    std::memcpy(fields + first, &word, sizeof word);
  }
}

// The corners of each triangle in turn.
HWY_INLINE void spread_corners(const std::byte* packed, unsigned vertex_count,
                               std::uint8_t (&fields)[3 * kMaxBlockTriangles]) {
  switch (corner_bits(vertex_count)) {
    case 4:
      return spread_fields<4>(packed, fields);
    case 5:
      return spread_fields<5>(packed, fields);
    default:
      return spread_fields<6>(packed, fields);
  }
}

#if HWY_TARGET != HWY_SCALAR

bool corners_on_target(const std::byte* packed, unsigned triangle_count, unsigned vertex_count,
                       std::uint8_t (&corners)[3][kMaxBlockTriangles]) {
  const ByteTag bytes;
  alignas(16) std::uint8_t fields[3 * kMaxBlockTriangles];
  spread_corners(packed, vertex_count, fields);
  hn::Vec<ByteTag> first, second, third;
  hn::LoadInterleaved3(bytes, fields, first, second, third);
  const auto used = hn::FirstN(bytes, triangle_count);
  const auto most = hn::Set(bytes, static_cast<std::uint8_t>(vertex_count - 1));
  const std::uint8_t* last = fields + 3 * (triangle_count - 1);
  auto greatest = hn::Zero(bytes);
  const auto store = [&](hn::Vec<ByteTag> of_all, std::uint8_t of_last, std::uint8_t* to) {
    const auto lanes = hn::IfThenElse(used, of_all, hn::Set(bytes, of_last));
    greatest = hn::Max(greatest, lanes);
    hn::StoreU(lanes, bytes, to);
  };
  store(first, last[0], corners[0]);
  store(second, last[1], corners[1]);
  store(third, last[2], corners[2]);
  return hn::AllTrue(bytes, hn::Eq(hn::Max(greatest, most), most));
}

// Four vertices at a time: a row of each coordinate.
float rows_on_target(const float* vertices, const std::uint32_t* places, unsigned stride,
                     float* rows) {
  const FourTag four;
  const hn::Repartition<std::uint64_t, FourTag> two;
  const auto vertex = [&](unsigned i) { return hn::LoadU(four, vertices + 3 * places[i]); };
  const auto halves = [&](Four low, Four high, auto join) {
    return hn::BitCast(four, join(two, hn::BitCast(two, low), hn::BitCast(two, high)));
  };
  const auto lower = [](auto tag, auto a, auto b) { return hn::InterleaveLower(tag, a, b); };
  const auto upper = [](auto tag, auto a, auto b) { return hn::InterleaveUpper(tag, a, b); };
  const float* first = vertices + 3 * places[0];
  const Four x0 = hn::Set(four, first[0]), y0 = hn::Set(four, first[1]);
  const Four z0 = hn::Set(four, first[2]);
  Four greatest = hn::Zero(four);
  for (unsigned i = 0; i < stride; i += 4) {
    const Four a = vertex(i), b = vertex(i + 1), c = vertex(i + 2), d = vertex(i + 3);
    const Four xy_ab = hn::InterleaveLower(four, a, b), xy_cd = hn::InterleaveLower(four, c, d);
    const Four z_ab = hn::InterleaveUpper(four, a, b), z_cd = hn::InterleaveUpper(four, c, d);
    const Vectors<Four> at{halves(xy_ab, xy_cd, lower), halves(xy_ab, xy_cd, upper),
                           halves(z_ab, z_cd, lower)};
    hn::StoreU(at.x, four, rows + i);
    hn::StoreU(at.y, four, rows + stride + i);
    hn::StoreU(at.z, four, rows + 2 * stride + i);
    const Vectors<Four> from_first = sub(at, {x0, y0, z0});
    greatest = hn::Max(greatest, dot(from_first, from_first));
  }
  return hn::GetLane(hn::MaxOfLanes(four, greatest));
}

#else

bool corners_on_target(const std::byte* packed, unsigned triangle_count, unsigned vertex_count,
                       std::uint8_t (&corners)[3][kMaxBlockTriangles]) {
  std::uint8_t fields[3 * kMaxBlockTriangles];
  spread_corners(packed, vertex_count, fields);
  bool good = true;
  for (unsigned lane = 0; lane < kMaxBlockTriangles; ++lane)
    for (unsigned corner = 0; corner < 3; ++corner) {
      const std::uint8_t vertex = fields[3 * std::min(lane, triangle_count - 1) + corner];
      good &= vertex < vertex_count;
      corners[corner][lane] = vertex;
    }
  return good;
}

float rows_on_target(const float* vertices, const std::uint32_t* places, unsigned stride,
                     float* rows) {
  float greatest = 0;
  for (unsigned i = 0; i < stride; ++i) {
    const float* vertex = vertices + 3 * places[i];
    for (unsigned axis = 0; axis < 3; ++axis) rows[axis * stride + i] = vertex[axis];
    const float x = vertex[0] - rows[0], y = vertex[1] - rows[stride];
    const float z = vertex[2] - rows[2 * stride];
    greatest = std::max(greatest, x * x + y * y + z * z);
  }
  return greatest;
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace planetree::octree
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planetree::octree {
namespace {

template <class T>
bool unpack_one_by_one(const Shuffled<T>& shuffled, std::size_t first, T* vertices) {
  const std::size_t count = shuffled.size() / 3;
  bool good = true;
  for (std::size_t i = first; i < count; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const T value = shuffled[axis * count + i];
      good &= std::fabs(value) <= T{kFarthestVertex};
      vertices[3 * i + axis] = value;
    }
  return good;
}

}  // namespace

HWY_EXPORT(vertices_on_target);
HWY_EXPORT(corners_on_target);
HWY_EXPORT(rows_on_target);

bool unpack_vertices(const Shuffled<float>& shuffled, float* vertices) noexcept {
  bool good = true;
  const std::size_t whole = HWY_DYNAMIC_DISPATCH(vertices_on_target)(
      shuffled.bytes(), shuffled.size() / 3, vertices, good);
  return good && unpack_one_by_one(shuffled, whole, vertices);
}

bool unpack_vertices(const Shuffled<double>& shuffled, double* vertices) noexcept {
  return unpack_one_by_one(shuffled, 0, vertices);
}

bool unpack_corners(std::span<const std::byte> packed, unsigned triangle_count,
                    unsigned vertex_count,
                    std::uint8_t (&corners)[3][kMaxBlockTriangles]) noexcept {
  // Whole words are read, whatever follows.
  std::array<std::byte, corner_bytes(kMaxBlockTriangles, kMaxBlockVertices) + 8> padded;
  const std::byte* bytes = packed.data();
  if (packed.size() < padded.size()) {
    padded.fill(std::byte{0});
    std::copy(packed.begin(), packed.end(), padded.begin());
    bytes = padded.data();
  }
  return HWY_DYNAMIC_DISPATCH(corners_on_target)(bytes, triangle_count, vertex_count, corners);
}

float unpack_rows(const float* vertices, const std::uint32_t* places, unsigned stride,
                  float* rows) noexcept {
  return HWY_DYNAMIC_DISPATCH(rows_on_target)(vertices, places, stride, rows);
}

}  // namespace planetree::octree
#endif
