#pragma once

#include <cstdint>
#include <string>

#include "tests/cache/explorer/execution.h"

namespace planetree::explorer {

/// Amount of exploration where exploring every run would take too long. Smaller in builds with
/// asserts, which include those with sanitizers: they are slow, and the explorer runs on one system
/// thread, so sanitizers have nothing to find in it.
#ifdef NDEBUG
inline constexpr std::uint32_t kFewPreemptions = 3;
inline constexpr std::uint64_t kRandomRuns = 50'000;
#else
inline constexpr std::uint32_t kFewPreemptions = 2;
inline constexpr std::uint64_t kRandomRuns = 5'000;
#endif

/// More preemptions than any program has steps.
inline constexpr std::uint32_t kAnyPreemptions = ~std::uint32_t{0};

/// Result of an exploration.
struct Report {
  std::uint64_t runs = 0;
  std::string failure;  ///< reason and steps of the failed run; empty if none failed
};

/// Executes every run with a limited number of preemptions, that is switches away from a thread
/// that could continue, and with every store that each load can return. Ends at the first run that
/// fails. Few preemptions reveal most mistakes.
Report explore_all(const MakeProgram& make, std::uint32_t max_preemptions);

/// Executes `runs` random runs, with any number of preemptions.
Report explore_at_random(const MakeProgram& make, std::uint64_t runs, std::uint64_t seed);

}  // namespace planetree::explorer
