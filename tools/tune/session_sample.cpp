#include "tools/tune/session_sample.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <random>

#include "tools/session/sorted.h"

namespace planetree::tools {
namespace {

constexpr double kQuantile = 0.99;

/// Calls take(first tick, length) for each run of degraded ticks.
template <class Take>
void for_each_run(std::span<const FeltTick> ticks, const Take& take) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= ticks.size(); ++i) {
    if (i < ticks.size() && ticks[i].is_degraded) continue;
    if (i > begin) take(begin, i - begin);
    begin = i + 1;
  }
}

}  // namespace

FeltFigures figures_of(std::span<const FeltTick> ticks) {
  FeltFigures figures;
  figures.ticks = ticks.size();
  std::vector<float> widths;
  std::vector<std::uint32_t> runs;
  for (const FeltTick& tick : ticks) {
    figures.degraded += tick.is_degraded;
    figures.misses += tick.misses;
    widths.push_back(tick.width);
  }
  for_each_run(ticks, [&](std::size_t, std::size_t length) {
    runs.push_back(static_cast<std::uint32_t>(length));
  });
  figures.width_p99 = Sorted<float>(std::move(widths)).at(kQuantile);
  const Sorted<std::uint32_t> sorted(std::move(runs));
  figures.ticks_to_exact_p99 = sorted.at(kQuantile);
  figures.longest_run = sorted.at(1);
  return figures;
}

SessionBlocks::SessionBlocks(std::span<const std::vector<FeltTick>> sessions,
                             TuneGoal::Quantity quantity)
    : sizes_(sessions.size() * kBlocksPerSession, 0),
      sums_(sizes_.size(), 0),
      is_mean_(quantity == TuneGoal::Quantity::kDegraded ||
               quantity == TuneGoal::Quantity::kMisses) {
  for (std::size_t session = 0; session < sessions.size(); ++session) {
    const std::vector<FeltTick>& ticks = sessions[session];
    const auto block_of = [&](std::size_t tick) {
      return static_cast<std::uint32_t>(session * kBlocksPerSession +
                                        tick * kBlocksPerSession / ticks.size());
    };
    if (quantity == TuneGoal::Quantity::kTicksToExact) {
      for_each_run(ticks, [&](std::size_t begin, std::size_t length) {
        const std::uint32_t block = block_of(begin);
        ++sizes_[block];
        parts_.push_back({static_cast<double>(length), block});
      });
      continue;
    }
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      const std::uint32_t block = block_of(i);
      ++sizes_[block];
      if (quantity == TuneGoal::Quantity::kDegraded)
        sums_[block] += ticks[i].is_degraded;
      else if (quantity == TuneGoal::Quantity::kMisses)
        sums_[block] += ticks[i].misses;
      else if (ticks[i].width > 0)
        parts_.push_back({static_cast<double>(ticks[i].width), block});
    }
  }
  std::stable_sort(parts_.begin(), parts_.end(),
                   [](const Part& a, const Part& b) { return a.value > b.value; });
}

double SessionBlocks::value_of(std::span<const std::uint32_t> blocks) const {
  std::uint64_t size = 0;
  double sum = 0;
  std::vector<std::uint32_t> times(sizes_.size(), 0);
  for (const std::uint32_t block : blocks) {
    size += sizes_[block];
    sum += sums_[block];
    ++times[block];
  }
  if (size == 0) return 0;
  if (is_mean_) return sum / static_cast<double>(size);
  // Counted from the greatest value, as Sorted counts from the least.
  const std::uint64_t rank =
      size - static_cast<std::uint64_t>(kQuantile * static_cast<double>(size));
  std::uint64_t counted = 0;
  for (const Part& part : parts_) {
    counted += times[part.block];
    if (counted >= rank) return part.value;
  }
  return 0;
}

double SessionBlocks::value() const {
  std::vector<std::uint32_t> all(sizes_.size());
  for (std::uint32_t block = 0; block < all.size(); ++block) all[block] = block;
  return value_of(all);
}

std::vector<std::vector<std::uint32_t>> drawn_sessions(std::size_t sessions, std::size_t count) {
  constexpr std::size_t kBlocks = SessionBlocks::kBlocksPerSession;
  assert(sessions > 0);
  std::mt19937_64 random(7);
  const auto below = [&](std::size_t limit) { return static_cast<std::size_t>(random() % limit); };
  std::vector<std::vector<std::uint32_t>> result;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = below(sessions) * kBlocks;
    // Another recording of the same session, and a session drawn from it.
    std::vector<std::uint32_t> recorded(kBlocks - 1), drawn = {static_cast<std::uint32_t>(first)};
    for (std::uint32_t& block : recorded)
      block = static_cast<std::uint32_t>(first + 1 + below(kBlocks - 1));
    for (std::size_t block = 1; block < kBlocks; ++block)
      drawn.push_back(recorded[below(recorded.size())]);
    result.push_back(std::move(drawn));
  }
  return result;
}

}  // namespace planetree::tools
