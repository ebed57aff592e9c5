#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "planetree/types.h"

namespace planetree::oracle {

/// One row of answers written by `planetree query`; numbers as in ClosestPoint.
struct AnswerRow {
  Vec3 query;
  double distance = 0, lower = 0, upper = 0;
  Side side = Side::kUnknown;
  std::uint64_t triangle = kNoTriangle;
  Status status = Status::kBadQuery;
  std::string text;  ///< the row itself
};

[[nodiscard]] bool is_finite(const Vec3& query);

/// Reads at most `most` rows of a CSV file of answers, whose first line names the columns.
///
/// errors  kBadInput: a column is missing, or a row is no answer
Result<std::vector<AnswerRow>> read_answers(std::istream& csv, std::size_t most);

}  // namespace planetree::oracle
