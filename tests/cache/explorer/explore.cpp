#include "tests/cache/explorer/explore.h"

#include "tests/cache/explorer/choices.h"

namespace planetree::explorer {
namespace {

Report explore(const MakeProgram& make, Choices& choices, std::uint32_t max_preemptions) {
  Execution execution(choices, max_preemptions);
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

Report explore_all(const MakeProgram& make, std::uint32_t max_preemptions) {
  EveryChoice choices;
  return explore(make, choices, max_preemptions);
}

Report explore_at_random(const MakeProgram& make, std::uint64_t runs, std::uint64_t seed) {
  RandomChoice choices(runs, seed);
  return explore(make, choices, kAnyPreemptions);
}

}  // namespace planetree::explorer
