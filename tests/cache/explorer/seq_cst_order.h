#pragma once

#include <cstdint>
#include <vector>

#include "tests/cache/explorer/knowledge.h"

namespace planetree::explorer {

/// The single total order of a run's seq_cst operations, as far as it is
/// decided: which of them must come before which. A run is possible as long as
/// this has no cycle.
///
/// It need not be the order in which the run happened to execute them, and not
/// even agree with happens-before where this goes through operations that are
/// not seq_cst (C++20 asks for the narrower strongly-happens-before). So it is
/// kept as a set of constraints. With the order of execution in its place,
/// behaviours would go missing that the language allows.
class SeqCstOrder {
 public:
  /// Operations, by bits; a run has at most 64.
  using Set = std::uint64_t;

  void clear() noexcept { operations_.clear(); }

  /// The operations that strongly happen before the next step of `thread`,
  /// which knows `known` up to now.
  Set strongly_before(std::uint32_t thread, const Knowledge& known) const noexcept;

  /// Whether an operation may come after all of `earlier` and before all of
  /// `later`.
  bool allows(Set earlier, Set later) const noexcept;

  /// Adds such an operation and returns it as a set of one.
  Set add(Step step, Set earlier, Set later);

 private:
  struct Operation {
    Step step;
    Set earlier;  ///< transitively
  };

  Set with_all_before(Set operations) const noexcept;

  std::vector<Operation> operations_;
};

}  // namespace planetree::explorer
