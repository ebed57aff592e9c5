#include "tools/tune/miss_curves.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <utility>

#include "tools/cli/policy_option.h"
#include "tools/tune/optimum.h"
#include "tools/tune/policy_replay.h"
#include "tools/tune/stack_distances.h"

namespace planetree::tools {
namespace {

std::vector<double> stack_misses(const References& references,
                                 std::span<const std::uint32_t> frames) {
  const StackDistances distances = StackDistances::of(references);
  std::vector<double> misses;
  for (const std::uint32_t count : frames)
    misses.push_back(static_cast<double>(distances.misses(count)));
  return misses;
}

/// Appends misses in caches of these sizes, `times` as many as of the references.
void append(const References& references, std::span<const std::uint32_t> frames, double times,
            MissCurves& curves) {
  for (const std::uint64_t misses : optimum_misses(references, frames))
    curves.optimum.push_back(times * static_cast<double>(misses));
  for (MissCurve& curve : curves.policies)
    for (const std::uint32_t count : frames)
      curve.misses.push_back(times *
                             static_cast<double>(replayed_misses(references, curve.policy, count)));
}

/// Appends the misses of all sizes from curves.first_sampled on.
void append_sampled(const References& references, MissCurves& curves) {
  const std::uint32_t step = curves.sampled_step;
  const References sample = references.sampled(step);
  std::vector<std::uint32_t> sizes;
  for (std::size_t i = curves.first_sampled; i < curves.frames.size(); ++i)
    sizes.push_back(1 + (curves.frames[i] - 1 + step / 2) / step);  // the root has a frame in both
  const std::vector<double> stack = stack_misses(sample, sizes);
  const double lookups = static_cast<double>(std::max<std::uint64_t>(references.lookups(), 1));
  for (std::size_t i = 0; i < sizes.size(); ++i)
    curves.error =
        std::max(curves.error,
                 std::fabs(step * stack[i] - curves.stack[curves.first_sampled + i]) / lookups);
  append(sample, sizes, step, curves);
}

}  // namespace

std::vector<std::uint32_t> curve_sizes(std::uint32_t footprint, std::size_t most) {
  constexpr double kMinFrames = 4;  // the fewest that a model opens with
  std::vector<std::uint32_t> sizes;
  const double last = std::max<double>(kMinFrames, footprint);
  for (std::size_t i = 0; i < most; ++i) {
    const double share = most == 1 ? 1 : static_cast<double>(i) / static_cast<double>(most - 1);
    const auto size =
        static_cast<std::uint32_t>(kMinFrames * std::pow(last / kMinFrames, share) + 0.5);
    if (sizes.empty() || size > sizes.back()) sizes.push_back(size);
  }
  return sizes;
}

MissCurves miss_curves(const References& references, const std::vector<std::uint32_t>& frames,
                       const CurveLimits& limits) {
  MissCurves curves;
  curves.frames = frames;
  curves.stack = stack_misses(references, curves.frames);
  for (const EvictionPolicy policy : kAllPolicies) curves.policies.push_back({policy, {}});
  if (references.stored().size() > limits.exact_lookups)
    curves.sampled_step = std::max(1U, references.footprint() / limits.sampled_pages);
  while (curves.first_sampled < curves.frames.size() &&
         (curves.sampled_step == 1 ||
          curves.frames[curves.first_sampled] / curves.sampled_step < limits.sampled_frames))
    ++curves.first_sampled;
  const auto exact = std::span(curves.frames).first(curves.first_sampled);
  append(references, exact, 1, curves);
  if (exact.size() < curves.frames.size()) append_sampled(references, curves);
  return curves;
}

void add_curves(const MissCurves& others, MissCurves& curves) {
  assert(others.frames == curves.frames);
  const auto add = [](const std::vector<double>& from, std::vector<double>& to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
  };
  add(others.stack, curves.stack);
  add(others.optimum, curves.optimum);
  for (std::size_t i = 0; i < curves.policies.size(); ++i)
    add(others.policies[i].misses, curves.policies[i].misses);
  curves.sampled_step = std::max(curves.sampled_step, others.sampled_step);
  curves.first_sampled = std::min(curves.first_sampled, others.first_sampled);
  curves.error = std::max(curves.error, others.error);
}

std::size_t knee_of(const std::vector<std::uint32_t>& frames, const std::vector<double>& misses) {
  std::size_t knee = 0;
  double farthest = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const double share = (static_cast<double>(frames[i]) - frames.front()) /
                         std::max(1.0, static_cast<double>(frames.back()) - frames.front());
    const double line = misses.front() + share * (misses.back() - misses.front());
    if (line - misses[i] > farthest) {
      farthest = line - misses[i];
      knee = i;
    }
  }
  return knee;
}

}  // namespace planetree::tools
