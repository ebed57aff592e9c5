#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "planetree/eviction_policy.h"
#include "tools/tune/references.h"

namespace planetree::tools {

/// Misses of one of the engine's policies in caches of several sizes.
struct MissCurve {
  EvictionPolicy policy;
  std::vector<double> misses;  ///< by size; whole numbers unless they are of a sample
};

/// How the misses of a trace depend on the number of frames.
struct MissCurves {
  std::vector<std::uint32_t> frames;  ///< sizes, ascending; the root's frame is one of them
  std::vector<double> stack;          ///< misses of LRU by stack distances
  std::vector<MissCurve> policies;    ///< of all policies, in the order of kAllPolicies
  std::vector<double> optimum;        ///< misses of Belady's optimum
  /// Of so many pages one was sampled; 1: all pages were replayed, and all curves are exact. The
  /// stack curve always is, and so are sizes below first_sampled.
  std::uint32_t sampled_step = 1;
  std::size_t first_sampled = 0;  ///< the first size whose misses are of the sample
  /// Greatest difference between the sampled stack curve and the exact one, as a miss ratio.
  double error = 0;
};

/// How to compute curves.
struct CurveLimits {
  /// Stored lookups up to which all pages are replayed.
  std::size_t exact_lookups = 10'000'000;
  /// Number of pages of a sample, at least.
  std::uint32_t sampled_pages = 32'768;
  /// Least number of frames of the sample's cache. Smaller caches are replayed with all pages.
  std::uint32_t sampled_frames = 128;
};

/// Sizes from 4 frames, the fewest that a model opens with, to the footprint, each larger than the
/// last by about the same factor.
std::vector<std::uint32_t> curve_sizes(std::uint32_t footprint, std::size_t most = 16);

/// Computes all curves for caches of some sizes. If there are more lookups than
/// `limits.exact_lookups`, and enough pages to sample, large caches are replayed with a sample of
/// the pages.
MissCurves miss_curves(const References& references, const std::vector<std::uint32_t>& frames,
                       const CurveLimits& limits = {});

/// Adds the misses of other lookups in caches of the same sizes. Each begins with an empty cache.
void add_curves(const MissCurves& others, MissCurves& curves);

/// The size beyond which more frames save little: where the curve is farthest below the line from
/// its first point to its last. Returns its place among the sizes.
std::size_t knee_of(const std::vector<std::uint32_t>& frames, const std::vector<double>& misses);

}  // namespace planetree::tools
