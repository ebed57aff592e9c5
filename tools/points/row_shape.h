#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace planetree::tools {

/// What the rows of an input are.
enum class RowKind : std::uint8_t { kPoint, kRay, kSweep };

/// The numbers of a row, in the order that they have without a header.
struct RowShape {
  static constexpr std::size_t kMaxNumbers = 8;

  RowKind kind;
  const char* noun;
  std::array<std::string_view, kMaxNumbers> names;
  std::size_t required;  ///< so many of the numbers every row has
  std::size_t count;     ///< with the optional ones

  [[nodiscard]] std::span<const std::string_view> all_names() const {
    return std::span(names).first(count);
  }
  /// The required names: "x,y,z".
  [[nodiscard]] std::string joined_names() const;
  /// The required names: "x, y and z", or with another word.
  [[nodiscard]] std::string listed_names(const char* word) const;
};

inline constexpr RowShape kPointShape{RowKind::kPoint, "point", {"x", "y", "z"}, 3, 3};
inline constexpr RowShape kRayShape{
    RowKind::kRay, "ray", {"x", "y", "z", "dx", "dy", "dz", "t_min", "t_max"}, 6, 8};
inline constexpr RowShape kSweepShape{
    RowKind::kSweep, "sweep", {"x0", "y0", "z0", "x1", "y1", "z1", "radius"}, 7, 7};

[[nodiscard]] constexpr const RowShape& shape_of(RowKind kind) {
  return kind == RowKind::kPoint ? kPointShape : kind == RowKind::kRay ? kRayShape : kSweepShape;
}

}  // namespace planetree::tools
