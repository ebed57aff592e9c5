#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "planetree/attributes.h"

namespace planetree::octree {

/// Attributes that readers deliver, and those among them that corners have.
inline constexpr std::uint32_t kCornerAttributes = kKeepColor | kKeepUv;
inline constexpr std::uint32_t kMeshAttributes = kCornerAttributes | kKeepValue;

/// What a corner has beside its position. What is not read is as it is here.
struct CornerAttributes {
  Color color;
  TextureCoordinate uv;
};

/// Bytes of the attributes of a corner, of which `keep` names those that are there.
constexpr std::size_t attribute_bytes(std::uint32_t keep) noexcept {
  return ((keep & kKeepColor) != 0 ? sizeof(Color) : 0) +
         ((keep & kKeepUv) != 0 ? sizeof(TextureCoordinate) : 0);
}

/// Writes the attributes that `keep` names.
inline void put_attributes(const CornerAttributes& attributes, std::uint32_t keep,
                           std::byte* to) noexcept {
  if ((keep & kKeepColor) != 0) {
    std::memcpy(to, &attributes.color, sizeof(Color));
    to += sizeof(Color);
  }
  if ((keep & kKeepUv) != 0) std::memcpy(to, &attributes.uv, sizeof(TextureCoordinate));
}

/// Reads what put_attributes() wrote.
inline CornerAttributes attributes_at(const std::byte* at, std::uint32_t keep) noexcept {
  CornerAttributes attributes;
  if ((keep & kKeepColor) != 0) {
    std::memcpy(&attributes.color, at, sizeof(Color));
    at += sizeof(Color);
  }
  if ((keep & kKeepUv) != 0) std::memcpy(&attributes.uv, at, sizeof(TextureCoordinate));
  return attributes;
}

/// The channel of a colour nearest to a number from 0 to 255. NaN is 0.
inline std::uint8_t to_channel(double value) noexcept {
  if (!(value > 0)) return 0;
  return value < 255 ? static_cast<std::uint8_t>(value + 0.5) : std::uint8_t{255};
}

}  // namespace planetree::octree
