#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "tests/oracle/answer_rows.h"
#include "tests/oracle/brute_force.h"

namespace planetree::oracle {

/// Collects evidence about one answer from triangles, added one at a time in any order.
class AnswerEvidence {
 public:
  explicit AnswerEvidence(const AnswerRow& answer) : answer_(&answer) {}

  /// Triangles farther than this need not be added as near ones.
  [[nodiscard]] double reach() const;
  void add_near(std::uint64_t index, const Corners& triangle);
  /// Adds the triangle that the answer names.
  void add_named(const Corners& triangle);
  /// Adds a triangle's crossing to the winding number; see ray_crossing().
  void add_ahead(const Corners& triangle);

  /// Fault of the distance, interval or triangle; empty if there is none.
  [[nodiscard]] std::string fault() const;
  /// Fault of the side; empty if there is none. For a watertight mesh, once all triangles that the
  /// ray may meet were added.
  [[nodiscard]] std::string side_fault() const;

 private:
  [[nodiscard]] bool is_exact() const { return answer_->status == Status::kExact; }
  [[nodiscard]] bool names_triangle() const { return answer_->triangle != kNoTriangle; }

  const AnswerRow* answer_;
  std::uint64_t nearer_ = kNoTriangle;  // least index of a triangle nearer than `lower`
  bool reached_ = false;                // a triangle is within `upper`
  bool on_surface_ = false;
  bool named_seen_ = false, named_within_ = false;
  // The first of the triangles that are nearest in double.
  double min_squared_ = std::numeric_limits<double>::infinity();
  std::uint64_t first_ = kNoTriangle;
  std::int64_t crossings_ = 0;
};

/// Fault of an answer's side if the true side is `truth`; empty if there is none. An unknown side
/// is a fault unless the answer is degraded.
std::string side_fault(const AnswerRow& answer, Side truth);

}  // namespace planetree::oracle
