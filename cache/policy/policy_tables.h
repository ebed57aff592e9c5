#pragma once

#include <cstdint>
#include <span>

#include "cache/policy/frame_list.h"
#include "cache/policy/frame_states.h"
#include "cache/policy/recency_heap.h"
#include "cache/policy/reference_bits.h"
#include "planetree/eviction_policy.h"

namespace planetree::cache {

/// Upper pages link to other pages; lower pages do not.
enum class PageTier : std::uint8_t { kLower, kUpper };

/// Memory of the policies. An array that a policy does not use is empty.
struct PolicyTables {
  // One element per frame.
  std::span<FrameStates::State> states = {};
  std::span<UseCount> counts = {};
  std::span<UseTime> uses = {};
  std::span<RecencyHeap::Entry> entries = {};
  std::span<FrameNode> nodes = {};

  std::span<UseTime> now = {};           ///< one element
  std::span<std::uint32_t> ghosts = {};  ///< one stamp per page, see GhostList
};

/// Takes the tables of a policy from a layout.
///
/// layout       an ArenaLayout: cut<T>(count) returns `count` elements, all 0
/// page_layout  another one, for the arrays of one element per page
template <class Layout, class PageLayout>
PolicyTables cut_policy_tables(EvictionPolicy policy, std::uint64_t frame_count,
                               std::uint64_t page_count, Layout& layout,
                               PageLayout& page_layout) noexcept {
  const bool keeps_times = policy == EvictionPolicy::kLru || policy == EvictionPolicy::kTwoQ;
  const bool keeps_ghosts = policy == EvictionPolicy::kS3Fifo || policy == EvictionPolicy::kTwoQ;
  PolicyTables tables;
  tables.states = layout.template cut<FrameStates::State>(frame_count);
  if (keeps_times) {
    tables.now = layout.template cut<UseTime>(1);
    tables.uses = layout.template cut<UseTime>(frame_count);
    tables.entries = layout.template cut<RecencyHeap::Entry>(frame_count);
  } else {
    tables.counts = layout.template cut<UseCount>(frame_count);
  }
  if (keeps_ghosts || policy == EvictionPolicy::kSieve)
    tables.nodes = layout.template cut<FrameNode>(frame_count);
  if (keeps_ghosts) tables.ghosts = page_layout.template cut<std::uint32_t>(page_count);
  return tables;
}
/// Takes all tables from one layout.
template <class Layout>
PolicyTables cut_policy_tables(EvictionPolicy policy, std::uint64_t frame_count,
                               std::uint64_t page_count, Layout& layout) noexcept {
  return cut_policy_tables(policy, frame_count, page_count, layout, layout);
}

}  // namespace planetree::cache
