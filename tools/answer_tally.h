#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <type_traits>

#include "planetree/contact.h"
#include "tools/answers/answer_words.h"
#include "tools/points/row_shape.h"

namespace planetree::tools {

/// Counts of answers by status, and by side or by what was hit. A query may have several answers.
class AnswerTally {
 public:
  explicit AnswerTally(const RowShape& shape) : shape_(shape) {}

  template <class Answer>
  void add(std::uint64_t query_count, std::span<const Answer> answers) {
    queries_ += query_count;
    for (const Answer& answer : answers) {
      ++by_status_[static_cast<std::size_t>(answer.status)];
      count(answer);
    }
  }

  [[nodiscard]] std::uint64_t queries() const { return queries_; }
  /// "points", "rays" or "sweeps".
  [[nodiscard]] std::string noun() const { return std::string(shape_.noun) + 's'; }
  /// The counts and the rate, as keys of a report.
  [[nodiscard]] nlohmann::ordered_json json(double seconds) const;
  /// "1,000 points in 2.0 s (500 points/s): 998 exact, 2 bad_query".
  [[nodiscard]] std::string text(double seconds) const;

 private:
  template <class Answer>
  void count(const Answer& answer) {
    if constexpr (std::is_same_v<Answer, RayHit>) {
      hits_ += answer.triangle != kNoTriangle ? 1 : 0;
      free_ += answer.status == Status::kExact && answer.triangle == kNoTriangle ? 1 : 0;
    } else if constexpr (std::is_same_v<Answer, FirstContact>) {
      hits_ += answer.at.triangle != kNoTriangle ? 1 : 0;
      free_ += answer.free ? 1 : 0;
    } else {
      ++by_side_[static_cast<std::size_t>(answer.side)];
    }
  }

  const RowShape& shape_;
  std::uint64_t queries_ = 0;
  std::array<std::uint64_t, kStatusCount> by_status_{};
  std::array<std::uint64_t, kSideCount> by_side_{};  // of points
  std::uint64_t hits_ = 0;                           // triangles hit or touched
  std::uint64_t free_ = 0;                           // rays and sweeps that certainly hit nothing
};

}  // namespace planetree::tools
