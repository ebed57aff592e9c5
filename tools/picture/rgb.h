#pragma once

#include <cstdint>

namespace planetree::tools {

/// An sRGB colour, 8 bits a channel.
struct Rgb {
  std::uint8_t red = 0, green = 0, blue = 0;

  bool operator==(const Rgb&) const = default;
};

/// The colour between two others: `a` for a share of 0, `b` for 1.
[[nodiscard]] constexpr Rgb mix(const Rgb& a, const Rgb& b, double share) {
  const auto channel = [share](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(from + (to - from) * share + 0.5);
  };
  return {channel(a.red, b.red), channel(a.green, b.green), channel(a.blue, b.blue)};
}

inline constexpr Rgb kInk = {18, 20, 32};         ///< text, axes and the surface
inline constexpr Rgb kPaper = {255, 255, 255};    ///< background
inline constexpr Rgb kNoValue = {150, 150, 150};  ///< pixels without a value

}  // namespace planetree::tools
