#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "planetree/types.h"

/// @file
/// Attributes of triangles: what a file keeps of a mesh beside its shape, on request
/// (BuildOptions::keep). They are in a layer of their own, by the index of the triangle, and
/// Model::triangle() reads them. The constants are combined with `|`.

namespace planetree {

/// Where each triangle is in the file, so that Model::triangle() finds its corners. Each of the
/// other attributes includes it.
inline constexpr std::uint32_t kKeepTriangles = 1;
/// The colours of the vertices.
inline constexpr std::uint32_t kKeepColor = 2;
/// The texture coordinates of the corners.
inline constexpr std::uint32_t kKeepUv = 4;
/// A value of 8 bytes for each triangle.
inline constexpr std::uint32_t kKeepValue = 8;
/// All attributes.
inline constexpr std::uint32_t kAllAttributes = kKeepTriangles | kKeepColor | kKeepUv | kKeepValue;

/// A colour of 8 bits a channel, as the mesh has it.
struct Color {
  std::uint8_t red = 0,  ///< 0 to 255
      green = 0,         ///< 0 to 255
      blue = 0,          ///< 0 to 255
      alpha = 255;       ///< 0 to 255; 255 if the mesh has none

  /// Whether all channels are equal.
  bool operator==(const Color&) const = default;
};

/// A position in a texture, as the mesh has it: usually from 0 to 1.
struct TextureCoordinate {
  float u = 0,  ///< first coordinate
      v = 0;    ///< second coordinate

  /// Whether both coordinates are equal.
  bool operator==(const TextureCoordinate&) const = default;
};

/// Type of the values of kKeepValue.
enum class ValueKind : std::uint8_t {
  kUnsigned,  ///< std::uint64_t
  kSigned,    ///< std::int64_t
  kReal       ///< double
};

/// Returns a value of kKeepValue, given by its bits, as a double. A whole number above 2^53 is
/// rounded.
inline double real_value(std::uint64_t bits, ValueKind kind) noexcept {
  if (kind == ValueKind::kReal) return std::bit_cast<double>(bits);
  return kind == ValueKind::kSigned ? static_cast<double>(static_cast<std::int64_t>(bits))
                                    : static_cast<double>(bits);
}

/// A triangle of the mesh by its index, and what the file keeps of it: see Model::triangle. What it
/// does not keep is as it is here.
struct MeshTriangle {
  std::array<Vec3, 3> corners = {};           ///< model units, as the mesh has them
  std::array<Color, 3> colors = {};           ///< of the corners, with kKeepColor
  std::array<TextureCoordinate, 3> uvs = {};  ///< of the corners, with kKeepUv
  std::uint64_t value = 0;                    ///< with kKeepValue: its bits, see real_value()

  /// Returns the colour at a point: the mean of the corners' colours, weighted by the barycentric
  /// coordinates of the point (ClosestPoint::barycentric), and rounded.
  Color color_at(const Vec3& barycentric) const noexcept {
    const auto mean = [&](std::uint8_t Color::*channel) {
      const double sum = barycentric.x * colors[0].*channel + barycentric.y * colors[1].*channel +
                         barycentric.z * colors[2].*channel;
      return static_cast<std::uint8_t>(sum > 0 ? (sum < 255 ? sum + 0.5 : 255) : 0);
    };
    return {mean(&Color::red), mean(&Color::green), mean(&Color::blue), mean(&Color::alpha)};
  }
  /// Returns the texture coordinates at a point, in the same way.
  TextureCoordinate uv_at(const Vec3& barycentric) const noexcept {
    const auto mean = [&](float TextureCoordinate::*axis) {
      return static_cast<float>(barycentric.x * double{uvs[0].*axis} +
                                barycentric.y * double{uvs[1].*axis} +
                                barycentric.z * double{uvs[2].*axis});
    };
    return {mean(&TextureCoordinate::u), mean(&TextureCoordinate::v)};
  }
  /// Returns the value as a double. A whole number above 2^53 is rounded.
  ///
  /// kind  ModelInfo::value_kind
  double real_value(ValueKind kind) const noexcept { return planetree::real_value(value, kind); }
};

}  // namespace planetree
