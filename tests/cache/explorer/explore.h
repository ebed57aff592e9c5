#pragma once

#include <cstdint>
#include <string>

#include "tests/cache/explorer/execution.h"

namespace planetree::explorer {

/// What came of exploring a program.
struct Report {
  std::uint64_t runs = 0;
  std::string failure;  ///< of the last run, with its steps; empty if none failed
};

/// Executes every run of a program in which threads that could have gone on are
/// stopped at most `preemptions` times, each with every store that its loads
/// can return; up to the first that fails. Few stops show most mistakes.
Report explore_all(const MakeProgram& make, std::uint32_t preemptions);

/// Executes `runs` of them at random, with any number of stops.
Report explore_at_random(const MakeProgram& make, std::uint64_t runs, std::uint64_t seed);

}  // namespace planetree::explorer
