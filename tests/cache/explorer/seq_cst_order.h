#pragma once

#include <cstdint>
#include <vector>

#include "tests/cache/explorer/knowledge.h"

namespace planetree::explorer {

/// The single total order of a run's seq_cst operations, as far as it is decided: constraints on
/// which of them come before which. A run is possible as long as the constraints have no cycle.
///
/// The total order may differ from the order of execution. It may even disagree with happens-before
/// where that passes through operations that are not seq_cst: C++20 requires only the narrower
/// strongly-happens-before. So it is kept as constraints; using the order of execution instead
/// would lose behaviours that the language allows.
class SeqCstOrder {
 public:
  /// Set of operations, one bit each; a run has at most 64.
  using Set = std::uint64_t;

  void clear() noexcept { operations_.clear(); }

  /// The operations that strongly happen before the next step of `thread`. `known` is what the
  /// thread knows before that step.
  Set strongly_before(std::uint32_t thread, const Knowledge& known) const noexcept;

  /// Whether an operation may come after all of `earlier` and before all of `later`.
  bool allows(Set earlier, Set later) const noexcept;

  /// Adds such an operation and returns the set that holds it alone.
  Set add(Step step, Set earlier, Set later);

 private:
  struct Operation {
    Step step;
    Set earlier;  ///< transitively closed
  };

  Set with_all_before(Set operations) const noexcept;

  std::vector<Operation> operations_;
};

}  // namespace planetree::explorer
