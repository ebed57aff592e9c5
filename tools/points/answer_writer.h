#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "planetree/types.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {

/// The words for enumerators of answers in all outputs.
[[nodiscard]] std::string_view feature_word(Feature feature);
[[nodiscard]] std::string_view side_word(Side side);
[[nodiscard]] std::string_view status_word(Status status);
inline constexpr std::size_t kStatusCount = 5;
inline constexpr std::size_t kSideCount = 4;

/// One row per point: CSV, one JSON object per line, or raw little-endian float64 values.
enum class AnswerFormat : std::uint8_t { kCsv, kJsonLines, kF64 };

/// Writes answers to standard output in one format, one row per point.
class AnswerWriter {
 public:
  AnswerWriter(Console& console, AnswerFormat format) : console_(console), format_(format) {}

  /// Writes the header of answers of this type. False once standard output takes no more.
  bool begin(const ClosestPoint&) {
    return heading("x,y,z,distance,lower,upper,side,px,py,pz,nx,ny,nz,triangle,feature,status\n");
  }
  bool begin(const Containment&) { return heading("x,y,z,side,status\n"); }
  /// Writes a row for each answer; the spans have equal lengths. False as in begin().
  bool write(std::span<const Vec3> queries, std::span<const ClosestPoint> answers);
  bool write(std::span<const Vec3> queries, std::span<const Containment> answers);

 private:
  bool heading(std::string_view names);

  Console& console_;
  AnswerFormat format_;
};

}  // namespace planetree::tools
