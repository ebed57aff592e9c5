#include "tests/cache/explorer/explore.h"

#include "tests/cache/explorer/choices.h"

namespace planetree::explorer {
namespace {

Report explore(const MakeProgram& make, Choices& choices, std::uint32_t stops) {
  Execution execution(choices, stops);
  Report report;
  bool passed = true;
  do {
    passed = execution.run(make);
    ++report.runs;
  } while (passed && choices.next_run());
  report.failure = execution.failure();
  return report;
}

}  // namespace

Report explore_all(const MakeProgram& make, std::uint32_t stops) {
  EveryChoice choices;
  return explore(make, choices, stops);
}

Report explore_at_random(const MakeProgram& make, std::uint64_t runs, std::uint64_t seed) {
  RandomChoice choices(runs, seed);
  return explore(make, choices, kAnyStops);
}

}  // namespace planetree::explorer
