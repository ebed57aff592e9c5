#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "tests/oracle/answer_rows.h"
#include "tests/oracle/brute_force.h"

namespace planetree::oracle {

/// What triangles have to say about one answer, as they pass one by one in any order.
class AnswerEvidence {
 public:
  explicit AnswerEvidence(const AnswerRow& answer) : answer_(&answer) {}

  /// Triangles farther than this need not be shown to see_near().
  [[nodiscard]] double reach() const;
  void see_near(std::uint64_t index, const Corners& triangle);
  /// The triangle that the answer names.
  void see_named(const Corners& triangle);
  /// Adds to the winding number; see ray_crossing().
  void see_ahead(const Corners& triangle);

  /// What is wrong with distance, interval or triangle; empty if nothing is.
  [[nodiscard]] std::string fault() const;
  /// What is wrong with the side, after all triangles ahead of a watertight mesh.
  [[nodiscard]] std::string side_fault() const;

 private:
  [[nodiscard]] bool is_exact() const { return answer_->status == Status::kExact; }
  [[nodiscard]] bool names_triangle() const { return answer_->triangle != kNoTriangle; }

  const AnswerRow* answer_;
  std::uint64_t nearer_ = kNoTriangle;  // than `lower`: the first such
  bool reached_ = false;                // a triangle is within `upper`
  bool on_surface_ = false;
  bool named_seen_ = false, named_within_ = false;
  // The first of those that are nearest in double.
  double min_squared_ = std::numeric_limits<double>::infinity();
  std::uint64_t first_ = kNoTriangle;
  std::int64_t crossings_ = 0;
};

/// What is wrong with an answer's side, if the true one is `truth`; empty if nothing is. That
/// a side is not told is wrong unless work or pages were missing.
std::string side_fault(const AnswerRow& answer, Side truth);

}  // namespace planetree::oracle
