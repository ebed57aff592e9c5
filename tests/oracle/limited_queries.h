#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "planetree/types.h"
#include "tests/oracle/brute_force.h"
#include "tests/oracle/random.h"

/// Queries of limited work and queries that never wait.
namespace planetree::oracle {

/// Whether an answer may stand beside that of a blocking query without a limit: an exact one has
/// its bits, another one an interval that meets it, and its side or none.
bool agrees(const ClosestPoint& answer, const ClosestPoint& exact);

/// Makes queries of limited work and queries that never wait, with the least memory that a file
/// opens with and with much, and compares them with blocking queries without a limit.
class LimitedQueries {
 public:
  /// A failure ends the test program with a message.
  explicit LimitedQueries(const std::filesystem::path& file);

  /// Queries a point with options drawn from `random`. Returns whether the answer agrees.
  bool agree(const Vec3& query, Random& random);

  /// Triangles that close the model's surface; none if it is watertight.
  [[nodiscard]] std::vector<Corners> caps() const;
  /// Number of answers so far that were exact.
  [[nodiscard]] std::size_t exact() const { return exact_; }
  /// The last query whose answer did not agree, and its answers.
  [[nodiscard]] const std::string& last_miss() const { return last_miss_; }

 private:
  Model large_, small_;
  Probe reference_, of_large_, of_small_;
  std::size_t exact_ = 0;
  std::string last_miss_;
};

}  // namespace planetree::oracle
