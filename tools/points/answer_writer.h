#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "planetree/types.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {

/// The words that stand for answers' enumerators wherever they are written.
[[nodiscard]] std::string_view feature_word(Feature feature);
[[nodiscard]] std::string_view side_word(Side side);
[[nodiscard]] std::string_view status_word(Status status);
inline constexpr std::size_t kStatusCount = 5;
inline constexpr std::size_t kSideCount = 4;

enum class AnswerFormat : std::uint8_t { kCsv, kJsonLines, kF64 };

/// Writes answers to standard output, one row for each point, in one format.
class AnswerWriter {
 public:
  AnswerWriter(Console& console, AnswerFormat format) : console_(console), format_(format) {}

  /// What comes before the first row of answers of this kind. False when output
  /// takes no more.
  bool begin(const ClosestPoint&) {
    return heading("x,y,z,distance,lower,upper,side,px,py,pz,nx,ny,nz,triangle,feature,status\n");
  }
  bool begin(const Containment&) { return heading("x,y,z,side,status\n"); }
  /// The spans are equally long. False when output takes no more.
  bool write(std::span<const Vec3> queries, std::span<const ClosestPoint> answers);
  bool write(std::span<const Vec3> queries, std::span<const Containment> answers);

 private:
  bool heading(std::string_view names);

  Console& console_;
  AnswerFormat format_;
};

}  // namespace planetree::tools
