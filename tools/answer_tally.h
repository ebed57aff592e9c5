#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "tools/points/answer_words.h"

namespace planetree::tools {

/// Counts of answers by status and by side. A point may have several.
struct AnswerTally {
  std::uint64_t points = 0;
  std::array<std::uint64_t, kStatusCount> by_status{};
  std::array<std::uint64_t, kSideCount> by_side{};

  template <class Answer>
  void add(std::uint64_t point_count, std::span<const Answer> answers) {
    points += point_count;
    for (const Answer& answer : answers) {
      ++by_status[static_cast<std::size_t>(answer.status)];
      ++by_side[static_cast<std::size_t>(answer.side)];
    }
  }

  /// The counts and the rate, as keys of a report.
  [[nodiscard]] nlohmann::ordered_json json(double seconds) const;
  /// "1,000 points in 2.0 s (500 points/s): 998 exact, 2 bad_query".
  [[nodiscard]] std::string text(double seconds) const;
};

}  // namespace planetree::tools
