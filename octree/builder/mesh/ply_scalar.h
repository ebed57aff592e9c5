#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>

/// Number types of a PLY file, and their values in a binary body.
namespace planetree::octree {

enum class PlyType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

/// The type that a header calls `name`, in any case: "uchar", "uint8" or "uint8_t". "long" has 64
/// bits.
std::optional<PlyType> ply_type_named(std::string_view name) noexcept;

constexpr std::uint64_t size_bytes(PlyType type) noexcept {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kInt64:
    case PlyType::kUint64:
    case PlyType::kFloat64:
      break;
  }
  return 8;
}

constexpr bool is_integer(PlyType type) noexcept {
  return type != PlyType::kFloat32 && type != PlyType::kFloat64;
}

/// Whether float32 holds every value of the type.
constexpr bool fits_float32(PlyType type) noexcept {
  return type == PlyType::kFloat32 || size_bytes(type) <= 2;
}

/// Reads a T at any address. `swap` says that the file's byte order is not the machine's.
template <class T>
T load(const std::byte* at, bool swap) noexcept {
  std::byte raw[sizeof(T)];
  if (swap) {
    for (std::size_t i = 0; i < sizeof(T); ++i) raw[i] = at[sizeof(T) - 1 - i];
  } else {
    std::memcpy(raw, at, sizeof(T));
  }
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return value;
}

/// Reads a coordinate of any type. The double holds its exact value, but is the nearest to an
/// integer of more than 53 bits.
inline double load_real(PlyType type, const std::byte* at, bool swap) noexcept {
  switch (type) {
    case PlyType::kInt8:
      return load<std::int8_t>(at, swap);
    case PlyType::kUint8:
      return load<std::uint8_t>(at, swap);
    case PlyType::kInt16:
      return load<std::int16_t>(at, swap);
    case PlyType::kUint16:
      return load<std::uint16_t>(at, swap);
    case PlyType::kInt32:
      return load<std::int32_t>(at, swap);
    case PlyType::kUint32:
      return load<std::uint32_t>(at, swap);
    case PlyType::kInt64:
      return static_cast<double>(load<std::int64_t>(at, swap));
    case PlyType::kUint64:
      return static_cast<double>(load<std::uint64_t>(at, swap));
    case PlyType::kFloat32:
      return static_cast<double>(load<float>(at, swap));
    case PlyType::kFloat64:
      break;
  }
  return load<double>(at, swap);
}

/// Reads a count or an index. `type` is an integer type. One that is too large gives the largest
/// that fits.
inline std::int64_t load_integer(PlyType type, const std::byte* at, bool swap) noexcept {
  switch (type) {
    case PlyType::kInt8:
      return load<std::int8_t>(at, swap);
    case PlyType::kUint8:
      return load<std::uint8_t>(at, swap);
    case PlyType::kInt16:
      return load<std::int16_t>(at, swap);
    case PlyType::kUint16:
      return load<std::uint16_t>(at, swap);
    case PlyType::kInt32:
      return load<std::int32_t>(at, swap);
    case PlyType::kUint32:
      return load<std::uint32_t>(at, swap);
    case PlyType::kInt64:
      return load<std::int64_t>(at, swap);
    default:
      break;
  }
  constexpr std::uint64_t kMax = std::numeric_limits<std::int64_t>::max();
  return static_cast<std::int64_t>(std::min(load<std::uint64_t>(at, swap), kMax));
}

}  // namespace planetree::octree
