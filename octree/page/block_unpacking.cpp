#include "octree/page/block_unpacking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "octree/page/block_unpacking.cpp"
#include <hwy/foreach_target.h>

#include "octree/geometry/strict_math.h"
#include "octree/geometry/tree_limits.h"
#include "octree/geometry/wide_floats-inl.h"
#include "octree/page/page_streams.h"
#include "octree/page/split_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace planetree::octree {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

using FourTag = hn::Repartition<float, ByteTag>;
using Four = hn::Vec<FourTag>;

// Unpacks whole groups of sixteen vertices. Returns the number of vertices in them.
std::size_t vertices_on_target(const std::byte* byte_split, std::size_t vertex_count,
                               float* vertices, bool& good) {
  const FourTag four;
  const Quads sign = hn::Set(QuadTag(), 0x80000000U);
  const std::size_t whole = vertex_count / 16 * 16;
  auto greatest = hn::Zero(QuadTag());
  for (std::size_t first = 0; first < whole; first += 16) {
    Quads x[4], y[4], z[4];
    const auto load = [&](std::size_t at, Quads(&floats)[4]) {
      Bytes planes[4];
      load_sixteen(byte_split, 3 * vertex_count, at, planes);
      join_planes(planes, floats);
    };
    load(first, x);
    load(first + vertex_count, y);
    load(first + 2 * vertex_count, z);
    for (std::size_t i = 0; i < 4; ++i) {
      hn::StoreInterleaved3(hn::BitCast(four, x[i]), hn::BitCast(four, y[i]),
                            hn::BitCast(four, z[i]), four, vertices + 3 * (first + 4 * i));
      // Without the sign, the bits of NaN exceed those of any number.
      for (const Quads& row : {x[i], y[i], z[i]})
        greatest = hn::Max(greatest, hn::AndNot(sign, row));
    }
  }
  const auto limit = hn::BitCast(QuadTag(), hn::Set(four, static_cast<float>(kMaxCoordinate)));
  good = hn::AllTrue(QuadTag(), hn::Eq(hn::Max(greatest, limit), limit));
  return whole;
}

#else

std::size_t vertices_on_target(const std::byte*, std::size_t, float*, bool&) { return 0; }

#endif

#if HWY_TARGET != HWY_SCALAR

// Extraction of one corner of eight triangles from the bytes that hold their corners: for each
// triangle the pair of bytes with the corner, and a factor that shifts it to the pair's end.
struct Extraction {
  alignas(16) std::uint8_t byte[16];
  alignas(16) std::uint16_t factor[8];
};

template <unsigned kBits>
constexpr Extraction extraction(unsigned corner) {
  Extraction taken{};
  for (unsigned i = 0; i < 8; ++i) {
    const unsigned bit = (3 * i + corner) * kBits;
    taken.byte[2 * i] = static_cast<std::uint8_t>(bit / 8);
    taken.byte[2 * i + 1] = static_cast<std::uint8_t>(bit / 8 + 1);
    taken.factor[i] = static_cast<std::uint16_t>(1U << (16 - kBits - bit % 8));
  }
  return taken;
}

// Returns one corner of each of sixteen triangles. `lower` holds the corners of the first eight,
// `upper` those of the others.
template <unsigned kBits, unsigned kCorner>
HWY_INLINE Bytes take_corner(Bytes lower, Bytes upper) {
  static_assert((3 * 7 + kCorner + 1) * kBits <= 128);
  constexpr Extraction kTaken = extraction<kBits>(kCorner);
  const ByteTag bytes;
  const PairTag pairs;
  const auto take = [&](Bytes packed) {
    const Pairs found =
        hn::BitCast(pairs, hn::TableLookupBytes(packed, hn::Load(bytes, kTaken.byte)));
    return hn::BitCast(bytes,
                       hn::ShiftRight<16 - kBits>(hn::Mul(found, hn::Load(pairs, kTaken.factor))));
  };
  return hn::ConcatEven(bytes, take(upper), take(lower));
}

template <unsigned kBits>
HWY_INLINE void take_corners(const std::uint8_t* packed, Bytes (&corners)[3]) {
  const ByteTag bytes;
  const Bytes lower = hn::LoadU(bytes, packed), upper = hn::LoadU(bytes, packed + 3 * kBits);
  corners[0] = take_corner<kBits, 0>(lower, upper);
  corners[1] = take_corner<kBits, 1>(lower, upper);
  corners[2] = take_corner<kBits, 2>(lower, upper);
}

// Extracts fields of six bits: eight fields from six bytes of a word.
HWY_INLINE void take_long_corners(const std::uint8_t* packed, Bytes (&corners)[3]) {
  alignas(16) std::uint8_t fields[3 * kMaxBlockTriangles];
  for (unsigned first = 0; first < 3 * kMaxBlockTriangles; first += 8) {
    std::uint64_t word;
    std::memcpy(&word, packed + first / 8 * 6, sizeof word);
    for (unsigned i = 0; i < 8; ++i)
      fields[first + i] = static_cast<std::uint8_t>(word >> 6 * i & 63);
  }
  hn::LoadInterleaved3(ByteTag(), fields, corners[0], corners[1], corners[2]);
}

// Packs four bits of each corner: those of triangles 0, 2, ..., 14, then 1, 3, ..., 15.
HWY_INLINE std::uint64_t pack_corners(Bytes row) {
  const ByteTag bytes;
  const QuadTag quads;
  const hn::Repartition<std::uint64_t, ByteTag> words;
  // Of four triangles, the first and third share a byte afterwards, and the second and fourth the
  // next.
  const Quads four = hn::BitCast(quads, row);
  const Bytes joined = hn::BitCast(bytes, hn::Or(four, hn::ShiftRight<12>(four)));
  alignas(16) static constexpr std::uint8_t kByte[] = {0, 4, 8, 12, 1, 5, 9, 13,
                                                       0, 4, 8, 12, 1, 5, 9, 13};
  return hn::GetLane(hn::BitCast(words, hn::TableLookupBytes(joined, hn::Load(bytes, kByte))));
}

bool corners_on_target(const std::uint8_t* stored, unsigned triangle_count, unsigned vertex_count,
                       BlockCorners& corners) {
  const ByteTag bytes;
  Bytes of_all[3];
  switch (corner_bits(vertex_count)) {
    case 4:
      take_corners<4>(stored, of_all);
      break;
    case 5:
      take_corners<5>(stored, of_all);
      break;
    default:
      take_long_corners(stored, of_all);
  }
  const Bytes last = hn::Set(bytes, static_cast<std::uint8_t>(triangle_count - 1));
  const Bytes lanes = hn::Min(hn::Iota(bytes, 0), last);
  const Bytes limit = hn::Set(bytes, static_cast<std::uint8_t>(vertex_count - 1));
  Bytes greatest = limit;
  for (std::size_t k = 0; k < 3; ++k) {
    const Bytes of_used = hn::TableLookupBytes(of_all[k], lanes);
    greatest = hn::Max(greatest, of_used);
    hn::StoreU(of_used, bytes, corners.row[k]);
    corners.packed[k] = pack_corners(of_used);
  }
  return hn::AllTrue(bytes, hn::Eq(greatest, limit));
}

// Transposes four vertices at a time into rows of coordinates.
float rows_on_target(const float* vertices, const std::uint16_t* indices, unsigned stride,
                     float* rows) {
  const FourTag four;
  const hn::Repartition<std::uint64_t, FourTag> two;
  const auto vertex = [&](unsigned i) { return hn::LoadU(four, vertices + 3 * indices[i]); };
  const auto halves = [&](Four low, Four high, auto join) {
    return hn::BitCast(four, join(two, hn::BitCast(two, low), hn::BitCast(two, high)));
  };
  const auto lower = [](auto tag, auto a, auto b) { return hn::InterleaveLower(tag, a, b); };
  const auto upper = [](auto tag, auto a, auto b) { return hn::InterleaveUpper(tag, a, b); };
  const float* first = vertices + 3 * indices[0];
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

bool corners_on_target(const std::uint8_t* stored, unsigned triangle_count, unsigned vertex_count,
                       BlockCorners& corners) {
  const unsigned bits = corner_bits(vertex_count);
  bool good = true;
  for (std::uint64_t& packed : corners.packed) packed = 0;
  for (unsigned lane = 0; lane < kMaxBlockTriangles; ++lane)
    for (unsigned corner = 0; corner < 3; ++corner) {
      const unsigned bit = (3 * std::min(lane, triangle_count - 1) + corner) * bits;
      const unsigned pair = stored[bit / 8] | unsigned{stored[bit / 8 + 1]} << 8;
      const unsigned vertex = pair >> bit % 8 & ((1U << bits) - 1);
      good &= vertex < vertex_count;
      corners.row[corner][lane] = static_cast<std::uint8_t>(vertex);
      corners.packed[corner] |= std::uint64_t{vertex & 15} << BlockHeader::corner_bit(lane);
    }
  return good;
}

float rows_on_target(const float* vertices, const std::uint16_t* indices, unsigned stride,
                     float* rows) {
  float greatest = 0;
  for (unsigned i = 0; i < stride; ++i) {
    const float* vertex = vertices + 3 * indices[i];
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
bool unpack_one_by_one(const ByteSplit<T>& byte_split, std::size_t first, T* vertices) {
  const std::size_t count = byte_split.size() / 3;
  bool good = true;
  for (std::size_t i = first; i < count; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const T value = byte_split[axis * count + i];
      good &= std::fabs(value) <= T{kMaxCoordinate};
      vertices[3 * i + axis] = value;
    }
  return good;
}

}  // namespace

HWY_EXPORT(vertices_on_target);
HWY_EXPORT(corners_on_target);
HWY_EXPORT(rows_on_target);

bool unpack_vertices(const ByteSplit<float>& byte_split, float* vertices) noexcept {
  bool good = true;
  const std::size_t whole = HWY_DYNAMIC_DISPATCH(vertices_on_target)(
      byte_split.bytes(), byte_split.size() / 3, vertices, good);
  return good && unpack_one_by_one(byte_split, whole, vertices);
}

bool unpack_vertices(const ByteSplit<double>& byte_split, double* vertices) noexcept {
  return unpack_one_by_one(byte_split, 0, vertices);
}

bool unpack_corners(std::span<const std::byte> stored, unsigned triangle_count,
                    unsigned vertex_count, BlockCorners& corners) noexcept {
  // Kernels read whole words and registers, beyond the block's last corner.
  std::array<std::byte, corner_bytes(kMaxBlockTriangles, kMaxBlockVertices) + 8> padded;
  const std::byte* bytes = stored.data();
  if (stored.size() < padded.size()) {
    padded.fill(std::byte{0});
    std::copy(stored.begin(), stored.end(), padded.begin());
    bytes = padded.data();
  }
  return HWY_DYNAMIC_DISPATCH(corners_on_target)(reinterpret_cast<const std::uint8_t*>(bytes),
                                                 triangle_count, vertex_count, corners);
}

float unpack_rows(const float* vertices, const std::uint16_t* indices, unsigned stride,
                  float* rows) noexcept {
  return HWY_DYNAMIC_DISPATCH(rows_on_target)(vertices, indices, stride, rows);
}

}  // namespace planetree::octree
#endif
