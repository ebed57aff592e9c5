#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "planetree/error.h"

namespace planetree::tools {

/// What a session is to keep below a limit.
struct TuneGoal {
  enum class Quantity : std::uint8_t {
    kDegraded,      ///< share of the answers that are degraded
    kWidth,         ///< 99 % quantile of the width of answers, upper - lower, model units
    kTicksToExact,  ///< 99 % quantile of the number of degraded answers in a row
    kMisses,        ///< pages read a query, of blocking queries
  };
  Quantity quantity = Quantity::kDegraded;
  double limit = 0;  ///< > 0

  /// Reads "degraded<0.1%", "width<0.5", "ticks<3" or "misses<0.05". Blanks around the sign are
  /// allowed, and a share may be a number or a percentage.
  static Result<TuneGoal> parse(std::string_view text);
};

/// The name of a quantity, as in the text of a goal.
const char* name_of(TuneGoal::Quantity quantity) noexcept;
/// A value of a quantity for people: "0.1 %", "3".
std::string text_of(TuneGoal::Quantity quantity, double value);

}  // namespace planetree::tools
