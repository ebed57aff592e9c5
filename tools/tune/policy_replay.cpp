#include "tools/tune/policy_replay.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>

#include "cache/policy/clock_policy.h"
#include "cache/policy/lru_policy.h"
#include "cache/policy/s3_fifo_policy.h"
#include "cache/policy/sieve_policy.h"
#include "cache/policy/two_q_policy.h"

namespace planetree::tools {
namespace {

using cache::kNoFrame;

/// Memory of a policy's tables: adds sizes up first, then gives out the memory.
class TableMemory {
 public:
  TableMemory(EvictionPolicy policy, std::uint32_t frames, std::uint32_t pages) {
    cache::cut_policy_tables(policy, frames, pages, *this);
    bytes_.resize(std::exchange(used_, 0));
    tables_ = cache::cut_policy_tables(policy, frames, pages, *this);
  }
  const cache::PolicyTables& tables() const { return tables_; }

  template <class T>
  std::span<T> cut(std::uint64_t count) {
    static_assert(alignof(T) <= kAlignment);
    const std::size_t begin = used_;
    used_ += (count * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
    if (bytes_.empty()) return {};
    return {reinterpret_cast<T*>(bytes_.data() + begin), count};
  }

 private:
  static constexpr std::size_t kAlignment = alignof(std::max_align_t);

  std::vector<std::byte> bytes_;
  std::size_t used_ = 0;
  cache::PolicyTables tables_;
};

template <class Policy>
class Replay {
 public:
  Replay(const References& references, EvictionPolicy kind, std::uint32_t frames)
      : references_(references),
        memory_(kind, frames, references.footprint()),
        states_(memory_.tables().states),
        policy_(memory_.tables()),
        frame_of_(references.pages().size(), kNoFrame),
        page_in_(frames) {
    install(0, root(), references.root_tier());
    states_.pin(0);
  }

  /// Calls on_miss(position among the stored lookups).
  template <class OnMiss>
  void run(const OnMiss& on_miss) {
    const auto lookups = references_.stored();
    const cache::ReferenceBits bits = policy_.reference_bits();
    for (std::size_t i = 0; i < lookups.size(); ++i) {
      const std::uint32_t page = lookups[i];
      if (const std::uint32_t frame = frame_of_[page]; frame != kNoFrame) {
        bits.mark(frame);
      } else {
        on_miss(i);
        make_resident(page);
      }
    }
  }

 private:
  /// A number that no other page has.
  std::uint32_t root() const { return references_.footprint() - 1; }

  void install(std::uint32_t frame, std::uint32_t page, cache::PageTier tier) {
    states_.install(frame);
    policy_.install(frame, page, tier);
  }

  void make_resident(std::uint32_t page) {
    std::uint32_t frame = used_frames_;
    if (used_frames_ < page_in_.size()) {
      ++used_frames_;
    } else {
      frame = policy_.choose_victim(states_);
      assert(frame != kNoFrame);
      states_.remove(frame);
      policy_.remove(frame);
      frame_of_[page_in_[frame]] = kNoFrame;
    }
    install(frame, page, references_.pages()[page].tier);
    page_in_[frame] = page;
    frame_of_[page] = frame;
  }

  const References& references_;
  TableMemory memory_;
  cache::FrameStates states_;
  Policy policy_;
  std::vector<std::uint32_t> frame_of_;  // by page; kNoFrame if it is not resident
  std::vector<std::uint32_t> page_in_;   // by frame
  std::uint32_t used_frames_ = 1;
};

template <class OnMiss>
void replay(const References& references, EvictionPolicy policy, std::uint32_t frames,
            const OnMiss& on_miss) {
  assert(frames >= 2);
  // Further frames would stay free.
  frames = std::min(frames, std::max(references.footprint(), std::uint32_t{2}));
  switch (policy) {
    case EvictionPolicy::kClock:
      return Replay<cache::ClockPolicy>(references, policy, frames).run(on_miss);
    case EvictionPolicy::kLru:
      return Replay<cache::LruPolicy>(references, policy, frames).run(on_miss);
    case EvictionPolicy::kSieve:
      return Replay<cache::SievePolicy>(references, policy, frames).run(on_miss);
    case EvictionPolicy::kS3Fifo:
      return Replay<cache::S3FifoPolicy>(references, policy, frames).run(on_miss);
    case EvictionPolicy::kTwoQ:
      return Replay<cache::TwoQPolicy>(references, policy, frames).run(on_miss);
  }
}

}  // namespace

std::uint64_t replayed_misses(const References& references, EvictionPolicy policy,
                              std::uint32_t frames) {
  std::uint64_t misses = 0;
  const std::size_t opening = references.opening();
  replay(references, policy, frames, [&](std::size_t i) { misses += i >= opening; });
  return misses;
}

std::vector<std::uint32_t> replayed_misses_by_query(const References& references,
                                                    EvictionPolicy policy, std::uint32_t frames) {
  const auto begins = references.query_begins();
  std::vector<std::uint32_t> misses(begins.size(), 0);
  std::size_t query = 0;
  replay(references, policy, frames, [&](std::size_t i) {
    if (begins.empty() || i < begins.front()) return;
    while (query + 1 < begins.size() && begins[query + 1] <= i) ++query;
    ++misses[query];
  });
  return misses;
}

}  // namespace planetree::tools
