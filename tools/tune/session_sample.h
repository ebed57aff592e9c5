#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/tune/tune_goal.h"

namespace planetree::tools {

/// One answer of a session, as far as goals concern it.
struct FeltTick {
  bool is_degraded = false;
  float width = 0;           ///< upper - lower, model units
  std::uint32_t misses = 0;  ///< pages that a blocking query read
};

/// What a session comes to.
struct FeltFigures {
  std::size_t ticks = 0;
  std::size_t degraded = 0;
  double width_p99 = 0;
  std::uint32_t ticks_to_exact_p99 = 0;
  std::uint32_t longest_run = 0;  ///< of degraded answers
  std::uint64_t misses = 0;
};
FeltFigures figures_of(std::span<const FeltTick> ticks);

/// Sessions cut into blocks of equal numbers of ticks, of which other sessions of the same kind can
/// be drawn. The first block of each session is one of its own kind, because nothing is in memory
/// when a session begins.
class SessionBlocks {
 public:
  static constexpr std::size_t kBlocksPerSession = 40;

  /// sessions  at least one, none empty
  SessionBlocks(std::span<const std::vector<FeltTick>> sessions, TuneGoal::Quantity quantity);

  /// The quantity in a session that consists of blocks, by their numbers.
  double value_of(std::span<const std::uint32_t> blocks) const;
  /// The quantity in all blocks.
  double value() const;

  std::size_t blocks() const { return sizes_.size(); }

 private:
  struct Part {
    double value;
    std::uint32_t block;
  };
  std::vector<std::uint32_t> sizes_;  // ticks, or runs of degraded ticks, of each block
  std::vector<double> sums_;          // of means: by block
  std::vector<Part> parts_;           // of quantiles: values above 0, descending
  bool is_mean_;
};

/// Numbers of the blocks of `count` sessions, each drawn from the blocks of one of the recorded
/// sessions. Their spread is that of fresh sessions: sessions differ from each other by more than
/// the blocks of one do, and what was recorded is taken for a draw itself.
std::vector<std::vector<std::uint32_t>> drawn_sessions(std::size_t sessions, std::size_t count);

}  // namespace planetree::tools
