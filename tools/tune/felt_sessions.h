#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "planetree/error.h"
#include "planetree/eviction_policy.h"
#include "planetree/types.h"
#include "tools/tune/session_sample.h"

namespace planetree::tools {

/// Replays recorded motions within memory budgets: the engine's own sessions on a simulated disk.
class FeltSessions {
 public:
  struct Options {
    std::filesystem::path file;
    std::uint32_t layers = 0;
    std::uint32_t rate_hz = 1000;
    std::uint64_t latency_ns = 85'000;
    std::vector<std::vector<Vec3>> paths;  ///< positions at the ticks of each session
    std::uint64_t pages = 0;               ///< pages that the recorded sessions had in memory
  };

  explicit FeltSessions(Options options) : options_(std::move(options)) {}

  /// Finds the budgets between which memory matters.
  ///
  /// errors  as Model::open
  Result<void> open();
  std::uint64_t least_bytes() const { return least_bytes_; }  ///< with which the model opens
  std::uint64_t most_bytes() const { return most_bytes_; }    ///< with which little is evicted
  std::uint64_t page_bytes() const { return page_bytes_; }
  /// Part of a budget that the frames do not have.
  std::uint64_t overhead_bytes() const { return overhead_bytes_; }
  std::pair<std::uint64_t, std::uint64_t> content_id() const { return content_id_; }
  Vec3 core_lower() const { return core_lower_; }
  Vec3 core_upper() const { return core_upper_; }

  /// The ticks of each session within a budget.
  Result<std::vector<std::vector<FeltTick>>> measure(std::uint64_t bytes, EvictionPolicy policy);
  /// Number of frames within a budget that was measured.
  std::uint32_t frames_within(std::uint64_t bytes, EvictionPolicy policy) const {
    const auto known = frames_.find({bytes, policy});
    return known == frames_.end() ? 0 : known->second;
  }
  /// Number of frames within any budget. Opens the model.
  Result<std::uint32_t> count_frames(std::uint64_t bytes, EvictionPolicy policy);

 private:
  const Options options_;
  std::uint64_t least_bytes_ = 0, most_bytes_ = 0, page_bytes_ = 0, overhead_bytes_ = 0;
  std::pair<std::uint64_t, std::uint64_t> content_id_;
  Vec3 core_lower_, core_upper_;
  std::map<std::pair<std::uint64_t, EvictionPolicy>, std::uint32_t> frames_;
};

}  // namespace planetree::tools
