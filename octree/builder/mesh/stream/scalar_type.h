#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

/// Number types of binary files, and their values.
namespace planetree::octree {

enum class ScalarType : std::uint8_t {
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

constexpr std::uint64_t size_bytes(ScalarType type) noexcept {
  switch (type) {
    case ScalarType::kInt8:
    case ScalarType::kUint8:
      return 1;
    case ScalarType::kInt16:
    case ScalarType::kUint16:
      return 2;
    case ScalarType::kInt32:
    case ScalarType::kUint32:
    case ScalarType::kFloat32:
      return 4;
    case ScalarType::kInt64:
    case ScalarType::kUint64:
    case ScalarType::kFloat64:
      break;
  }
  return 8;
}

constexpr bool is_integer(ScalarType type) noexcept {
  return type != ScalarType::kFloat32 && type != ScalarType::kFloat64;
}

/// Whether float32 holds every value of the type.
constexpr bool fits_float32(ScalarType type) noexcept {
  return type == ScalarType::kFloat32 || size_bytes(type) <= 2;
}

/// Whether the machine's byte order is not that of little-endian files.
inline constexpr bool kSwapLittle = std::endian::native != std::endian::little;

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
inline double load_real(ScalarType type, const std::byte* at, bool swap) noexcept {
  switch (type) {
    case ScalarType::kInt8:
      return load<std::int8_t>(at, swap);
    case ScalarType::kUint8:
      return load<std::uint8_t>(at, swap);
    case ScalarType::kInt16:
      return load<std::int16_t>(at, swap);
    case ScalarType::kUint16:
      return load<std::uint16_t>(at, swap);
    case ScalarType::kInt32:
      return load<std::int32_t>(at, swap);
    case ScalarType::kUint32:
      return load<std::uint32_t>(at, swap);
    case ScalarType::kInt64:
      return static_cast<double>(load<std::int64_t>(at, swap));
    case ScalarType::kUint64:
      return static_cast<double>(load<std::uint64_t>(at, swap));
    case ScalarType::kFloat32:
      return static_cast<double>(load<float>(at, swap));
    case ScalarType::kFloat64:
      break;
  }
  return load<double>(at, swap);
}

/// Reads a count or an index. `type` is an integer type. One that is too large gives the largest
/// that fits.
inline std::int64_t load_integer(ScalarType type, const std::byte* at, bool swap) noexcept {
  switch (type) {
    case ScalarType::kInt8:
      return load<std::int8_t>(at, swap);
    case ScalarType::kUint8:
      return load<std::uint8_t>(at, swap);
    case ScalarType::kInt16:
      return load<std::int16_t>(at, swap);
    case ScalarType::kUint16:
      return load<std::uint16_t>(at, swap);
    case ScalarType::kInt32:
      return load<std::int32_t>(at, swap);
    case ScalarType::kUint32:
      return load<std::uint32_t>(at, swap);
    case ScalarType::kInt64:
      return load<std::int64_t>(at, swap);
    default:
      break;
  }
  constexpr std::uint64_t kMax = std::numeric_limits<std::int64_t>::max();
  return static_cast<std::int64_t>(std::min(load<std::uint64_t>(at, swap), kMax));
}

}  // namespace planetree::octree
