#pragma once

#include <cstdint>
#include <string>

#include "tests/cache/explorer/execution.h"

namespace planetree::explorer {

/// How much tests explore where it is not every run. Less in builds with
/// asserts, which include those with sanitizers: they are slow, and the
/// explorer, being one thread of the system, gives them nothing to find.
#ifdef NDEBUG
inline constexpr std::uint32_t kFewStops = 3;
inline constexpr std::uint64_t kRandomRuns = 50'000;
#else
inline constexpr std::uint32_t kFewStops = 2;
inline constexpr std::uint64_t kRandomRuns = 5'000;
#endif

/// More stops than any program has steps.
inline constexpr std::uint32_t kAnyStops = ~std::uint32_t{0};

/// What came of exploring a program.
struct Report {
  std::uint64_t runs = 0;
  std::string failure;  ///< of the last run, with its steps; empty if none failed
};

/// Executes every run of a program in which threads that could have gone on are
/// stopped at most `stops` times, each with every store that its loads can
/// return; up to the first that fails. Few stops show most mistakes.
Report explore_all(const MakeProgram& make, std::uint32_t stops);

/// Executes `runs` of them at random, with any number of stops.
Report explore_at_random(const MakeProgram& make, std::uint64_t runs, std::uint64_t seed);

}  // namespace planetree::explorer
