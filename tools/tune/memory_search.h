#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "planetree/error.h"
#include "tools/tune/session_sample.h"
#include "tools/tune/tune_goal.h"

namespace planetree::tools {

/// Measures sessions within a memory budget: the ticks of each.
using MeasureSessions =
    std::function<Result<std::vector<std::vector<FeltTick>>>(std::uint64_t bytes)>;

/// The least memory with which a session keeps a goal.
struct MemoryNeeded {
  /// 97.5 % of the drawn sessions keep the goal with a little less. Sessions differ from each other
  /// by more than the parts of one do, so a margin comes on top: a step, or 5 % of the memory that
  /// the search can take away.
  std::uint64_t recommended = 0;
  std::uint64_t low = 0;   ///< 5 % of them keep it with so little
  std::uint64_t high = 0;  ///< 99 % of them keep it
};

/// Searches for the least memory that keeps a goal. A goal counts as kept within a budget only if
/// it is kept within all greater ones that were measured.
class MemorySearch {
 public:
  /// least, most  budgets in bytes; with `most` nothing is evicted
  /// step         least difference between budgets that matters, such as the size of a page
  MemorySearch(TuneGoal goal, std::uint64_t least, std::uint64_t most, std::uint64_t step,
               MeasureSessions measure);

  /// Measures within some budgets, evenly by their logarithms, from the greatest down to the first
  /// that misses the goal by far.
  Result<void> measure_grid();
  /// Measures the grid and then bisects. Returns nothing if more than one in 40 sessions would not
  /// keep the goal within `most`.
  Result<std::optional<MemoryNeeded>> search();

  /// Whether enough of the drawn sessions keep the goal within `most`.
  Result<bool> keeps_goal_with_most();

  /// What was measured within a budget.
  struct Measured {
    std::vector<FeltFigures> sessions;
    double value = 0;           ///< of all sessions together
    std::vector<double> drawn;  ///< in each of the drawn sessions
  };
  /// By budget.
  const std::map<std::uint64_t, Measured>& measured() const { return measured_; }

 private:
  /// A share of the drawn sessions needs at most so much: the budget, and the greatest measured one
  /// below.
  struct Bracket {
    std::uint64_t too_little = 0;
    std::uint64_t enough = 0;  ///< 0: `most` is too little
  };
  Result<void> measure(std::uint64_t bytes);
  Bracket bracket_of(double share) const;
  Result<Bracket> narrowed(double share);

  const TuneGoal goal_;
  const std::uint64_t least_, most_, step_;
  const MeasureSessions measure_;
  std::map<std::uint64_t, Measured> measured_;
  std::vector<std::vector<std::uint32_t>> draws_;
};

}  // namespace planetree::tools
