#include "tests/cache/explorer/seq_cst_order.h"

#include <cstddef>
#include <cstdio>
#include <cstdlib>

namespace planetree::explorer {
namespace {

constexpr std::size_t kMaxOperations = 64;

constexpr SeqCstOrder::Set only(std::size_t operation) noexcept {
  return SeqCstOrder::Set{1} << operation;
}

}  // namespace

// [intro.races]: strongly before a step is what is sequenced before it in the same thread, and what
// is sequenced before a step that happens before one sequenced before it. The latter is all that
// another thread did before its last step that this thread knows of, provided that this thread knew
// it before its own step: `known` lacks what the step itself acquires. Coherence already orders a
// seq_cst load after the seq_cst store that it reads.
SeqCstOrder::Set SeqCstOrder::strongly_before(std::uint32_t thread,
                                              const Knowledge& known) const noexcept {
  Set before = 0;
  for (std::size_t i = 0; i < operations_.size(); ++i) {
    const Step step = operations_[i].step;
    if (step.thread == thread || step.time < known.time_of(step.thread)) before |= only(i);
  }
  return before;
}

SeqCstOrder::Set SeqCstOrder::with_all_before(Set operations) const noexcept {
  Set all = operations;
  for (std::size_t i = 0; i < operations_.size(); ++i) {
    if ((operations & only(i)) != 0) all |= operations_[i].earlier;
  }
  return all;
}

bool SeqCstOrder::allows(Set earlier, Set later) const noexcept {
  return (with_all_before(earlier) & later) == 0;
}

SeqCstOrder::Set SeqCstOrder::add(Step step, Set earlier, Set later) {
  if (operations_.size() == kMaxOperations) {
    std::fputs("explorer: too many seq_cst operations in one run\n", stderr);
    std::abort();
  }
  const Set self = only(operations_.size());
  const Set before = with_all_before(earlier);
  for (std::size_t i = 0; i < operations_.size(); ++i) {
    if (((only(i) | operations_[i].earlier) & later) != 0) operations_[i].earlier |= before | self;
  }
  operations_.push_back({step, before});
  return self;
}

}  // namespace planetree::explorer
