#include "tests/cache/explorer/memory.h"

#include <cstdio>
#include <cstdlib>

namespace planetree::explorer {
namespace {

bool acquires(std::memory_order order) noexcept {
  return order == std::memory_order_acquire || order == std::memory_order_acq_rel ||
         order == std::memory_order_seq_cst;
}

bool releases(std::memory_order order) noexcept {
  return order == std::memory_order_release || order == std::memory_order_acq_rel ||
         order == std::memory_order_seq_cst;
}

}  // namespace

void Memory::clear() noexcept {
  known_ = {};
  for (std::size_t i = 0; i < atomic_count_; ++i) histories_[i].clear();
  atomic_count_ = 0;
  plains_.clear();
  order_.clear();
}

std::size_t Memory::add_atomic(std::uint64_t value) {
  if (atomic_count_ == kMaxAtomics) {
    std::fputs("explorer: too many atomics in one program\n", stderr);
    std::abort();
  }
  histories_[atomic_count_].push_back(Store{value, {}});
  return atomic_count_++;
}

std::size_t Memory::add_plain() {
  plains_.push_back({});
  return plains_.size() - 1;
}

Step Memory::next_step(std::uint32_t thread) noexcept {
  const Step step{thread, static_cast<std::uint16_t>(known_[thread].time_of(thread) + 1)};
  known_[thread].set_time(step);
  return step;
}

/// The seq_cst operations on an atomic that coherence orders before a load of `store`: the stores
/// up to it, and the loads of older stores.
Memory::Set Memory::coherence_before(const History& history, std::size_t store) noexcept {
  Set before = history[store].seq_cst_store;
  for (std::size_t i = 0; i < store; ++i) {
    before |= history[i].seq_cst_store | history[i].seq_cst_loads;
  }
  return before;
}

/// The seq_cst operations that coherence orders after a load of `store`: newer stores and their
/// loads.
Memory::Set Memory::coherence_after(const History& history, std::size_t store) noexcept {
  Set after = 0;
  for (std::size_t i = store + 1; i < history.size(); ++i) {
    after |= history[i].seq_cst_store | history[i].seq_cst_loads;
  }
  return after;
}

Memory::Loaded Memory::load(std::uint32_t thread, std::size_t atomic, std::memory_order order,
                            Choices& choices) {
  History& history = histories_[atomic];
  const bool seq_cst = order == std::memory_order_seq_cst;
  const Set strongly_before = seq_cst ? order_.strongly_before(thread, known_[thread]) : 0;
  // Newest first, so that the first run explored is the expected one.
  candidates_.clear();
  for (std::size_t i = history.size(); i-- > known_[thread].oldest_visible(atomic);) {
    if (!seq_cst || order_.allows(strongly_before | coherence_before(history, i),
                                  coherence_after(history, i))) {
      candidates_.push_back(static_cast<std::uint32_t>(i));
    }
  }
  // The newest store is always a candidate: nothing is ordered after its load yet.
  const std::size_t found =
      candidates_[choices.choose(static_cast<std::uint32_t>(candidates_.size()))];
  const Step step = next_step(thread);
  if (seq_cst) {
    history[found].seq_cst_loads |= order_.add(
        step, strongly_before | coherence_before(history, found), coherence_after(history, found));
  }
  known_[thread].saw(atomic, found);
  if (acquires(order)) known_[thread].add(history[found].released);
  return {history[found].value, history.size() - 1 - found};
}

/// Appends `made` as the newest store, ordered after all stores and loads so far.
void Memory::append(std::uint32_t thread, std::size_t atomic, Store made, std::memory_order order) {
  History& history = histories_[atomic];
  const std::size_t newest = history.size() - 1;
  const Set strongly_before = order_.strongly_before(thread, known_[thread]);
  const Step step = next_step(thread);
  if (order == std::memory_order_seq_cst) {
    made.seq_cst_store = order_.add(
        step, strongly_before | coherence_before(history, newest) | history[newest].seq_cst_loads,
        0);
  }
  known_[thread].saw(atomic, newest + 1);
  if (releases(order)) made.released.add(known_[thread]);
  history.push_back(made);
}

void Memory::store(std::uint32_t thread, std::size_t atomic, std::uint64_t value,
                   std::memory_order order) {
  append(thread, atomic, Store{value, {}}, order);
}

std::uint64_t Memory::exchange(std::uint32_t thread, std::size_t atomic, std::uint64_t value,
                               std::memory_order order) {
  const Store replaced = histories_[atomic].back();
  // An exchange continues the release sequence of the store it replaces: a thread that acquires
  // from it also learns what the replaced store released.
  append(thread, atomic, Store{value, replaced.released}, order);
  if (acquires(order)) known_[thread].add(replaced.released);
  return replaced.value;
}

bool Memory::read_plain(std::uint32_t thread, std::size_t plain) {
  const Step step = next_step(thread);
  plains_[plain].read[thread] = step.time;
  return known_[thread].includes(plains_[plain].written);
}

bool Memory::write_plain(std::uint32_t thread, std::size_t plain) {
  const Step step = next_step(thread);
  Plain& touched = plains_[plain];
  bool ordered = known_[thread].includes(touched.written);
  for (std::uint32_t i = 0; i < kMaxThreads; ++i) {
    ordered = ordered && known_[thread].includes({i, touched.read[i]});
  }
  touched.written = step;
  return ordered;
}

Knowledge Memory::publish_knowledge(std::uint32_t thread) {
  next_step(thread);
  return known_[thread];
}

void Memory::learn(std::uint32_t thread, const Knowledge& knowledge) noexcept {
  known_[thread].add(knowledge);
}

}  // namespace planetree::explorer
