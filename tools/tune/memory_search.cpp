#include "tools/tune/memory_search.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace planetree::tools {
namespace {

constexpr std::size_t kDraws = 400;
constexpr int kGridSizes = 12;
constexpr double kRecommended = 0.975, kLow = 0.05, kHigh = 0.99;
/// Budgets nearer to each other than this share are not told apart.
constexpr double kPrecision = 0.01;
constexpr double kMargin = 0.05;
/// Sessions that miss the goal by this factor are not measured with still less memory: they read
/// pages without end, which takes long.
constexpr double kFarFromGoal = 20;

}  // namespace

MemorySearch::MemorySearch(TuneGoal goal, std::uint64_t least, std::uint64_t most,
                           std::uint64_t step, MeasureSessions measure)
    : goal_(goal),
      least_(least),
      most_(std::max(least, most)),
      step_(step),
      measure_(std::move(measure)) {
  assert(least > 0 && step > 0);
}

Result<void> MemorySearch::measure(std::uint64_t bytes) {
  if (measured_.contains(bytes)) return {};
  const auto sessions = measure_(bytes);
  if (!sessions) return sessions.error();
  if (draws_.empty()) draws_ = drawn_sessions(sessions->size(), kDraws);
  Measured measured;
  for (const auto& ticks : *sessions) measured.sessions.push_back(figures_of(ticks));
  const SessionBlocks blocks(*sessions, goal_.quantity);
  measured.value = blocks.value();
  for (const auto& draw : draws_) measured.drawn.push_back(blocks.value_of(draw));
  measured_.emplace(bytes, std::move(measured));
  return {};
}

Result<void> MemorySearch::measure_grid() {
  const double ratio = static_cast<double>(most_) / static_cast<double>(least_);
  for (int i = kGridSizes - 1; i >= 0; --i) {
    const double share = static_cast<double>(i) / (kGridSizes - 1);
    const double bytes = static_cast<double>(least_) * std::pow(ratio, share);
    const auto above = static_cast<std::uint64_t>(bytes - static_cast<double>(least_));
    const std::uint64_t budget = i == kGridSizes - 1 ? most_ : least_ + above / step_ * step_;
    if (const auto done = measure(budget); !done) return done;
    if (measured_.at(budget).value > kFarFromGoal * goal_.limit) break;
  }
  return {};
}

MemorySearch::Bracket MemorySearch::bracket_of(double share) const {
  // From the greatest number down, as long as enough sessions keep the goal with all so far.
  std::vector<bool> keeps(kDraws, true);
  Bracket bracket;
  for (auto at = measured_.rbegin(); at != measured_.rend(); ++at) {
    std::size_t kept = 0;
    for (std::size_t draw = 0; draw < kDraws; ++draw) {
      if (at->second.drawn[draw] >= goal_.limit) keeps[draw] = false;
      kept += keeps[draw];
    }
    if (static_cast<double>(kept) < share * kDraws) {
      bracket.too_little = at->first;
      return bracket;
    }
    bracket.enough = at->first;
  }
  return bracket;
}

Result<MemorySearch::Bracket> MemorySearch::narrowed(double share) {
  for (;;) {
    const Bracket bracket = bracket_of(share);
    if (bracket.enough == 0 || bracket.too_little == 0) return bracket;
    const std::uint64_t gap = bracket.enough - bracket.too_little;
    if (gap <= step_ ||
        static_cast<double>(gap) <= kPrecision * static_cast<double>(bracket.enough))
      return bracket;
    const std::uint64_t half = std::max(step_, gap / 2 / step_ * step_);
    if (const auto done = measure(bracket.too_little + half); !done) return done.error();
  }
}

Result<bool> MemorySearch::keeps_goal_with_most() {
  if (const auto done = measure(most_); !done) return done.error();
  return bracket_of(kRecommended).enough == most_;
}

Result<std::optional<MemoryNeeded>> MemorySearch::search() {
  if (const auto done = measure_grid(); !done) return done.error();
  const auto needed = narrowed(kRecommended);
  if (!needed) return needed.error();
  if (needed->enough == 0) return std::optional<MemoryNeeded>();
  const auto above = static_cast<double>(needed->enough - least_);
  const std::uint64_t margin =
      std::max(step_, static_cast<std::uint64_t>(kMargin * above) / step_ * step_);
  const std::uint64_t recommended = std::min(most_, needed->enough + margin);
  if (const auto done = measure(recommended); !done) return done.error();
  const std::uint64_t high = bracket_of(kHigh).enough;
  return std::optional<MemoryNeeded>(
      {recommended, bracket_of(kLow).enough, std::max(recommended, high == 0 ? most_ : high)});
}

}  // namespace planetree::tools
