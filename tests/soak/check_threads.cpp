// Runs readers and a writer of the cache at full speed and checks that every word read is of the
// requested page.
// usage: check_threads [QUERIES INSTALLS]
//        check_threads --weakened NAME
//
// The first form runs at least 10 million queries and a million installs on the protocol's own
// classes, then on a whole PageCache; exit status 1 if a word is wrong. Built with a thread
// sanitizer, a data race ends it with status 66. The second form runs the classes with one memory
// order weakened, or with one mistake of the writer, until a word is wrong; a fault that it does
// not find by then does not show on this processor. --list prints the names.

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>

#include "tests/cache/protocol_stress.h"

namespace planetree::cache {
namespace {

template <ProtocolStep kStep, std::memory_order kOrder>
struct WeakenedAtomics : StdAtomics {
  static constexpr std::memory_order order(ProtocolStep step) noexcept {
    return step == kStep ? kOrder : order_of(step);
  }
};

using Stress = std::function<StressCount(const StressGoal&)>;

template <ProtocolStep kStep, std::memory_order kOrder>
Stress weakened() {
  return
      [](const StressGoal& goal) { return stress_protocol<WeakenedAtomics<kStep, kOrder>>(goal); };
}

Stress mistaken(WriterMistake mistake) {
  return [mistake](const StressGoal& goal) { return stress_protocol(goal, mistake); };
}

const std::map<std::string, Stress>& weakened_runs() {
  static const std::map<std::string, Stress> all = {
      {"R1Release", weakened<ProtocolStep::kEnter, std::memory_order_release>()},
      {"R1Relaxed", weakened<ProtocolStep::kEnter, std::memory_order_relaxed>()},
      {"R2Acquire", weakened<ProtocolStep::kFind, std::memory_order_acquire>()},
      {"R2Relaxed", weakened<ProtocolStep::kFind, std::memory_order_relaxed>()},
      {"R5Relaxed", weakened<ProtocolStep::kLeave, std::memory_order_relaxed>()},
      {"E2Release", weakened<ProtocolStep::kWithdraw, std::memory_order_release>()},
      {"E2Relaxed", weakened<ProtocolStep::kWithdraw, std::memory_order_relaxed>()},
      {"E3Acquire", weakened<ProtocolStep::kNoteSections, std::memory_order_acquire>()},
      {"E3Relaxed", weakened<ProtocolStep::kNoteSections, std::memory_order_relaxed>()},
      {"E5Relaxed", weakened<ProtocolStep::kSeeSectionEnd, std::memory_order_relaxed>()},
      {"I7Relaxed", weakened<ProtocolStep::kPublish, std::memory_order_relaxed>()},
      {"ReusesAtOnce", mistaken(WriterMistake::kReusesAtOnce)},
      {"ForgetsAReader", mistaken(WriterMistake::kForgetsAReader)},
      {"NotesTooEarly", mistaken(WriterMistake::kNotesTooEarly)}};
  return all;
}

// Prints the counts; returns whether no word was wrong.
bool report(const char* what, const StressCount& count) {
  std::printf("%s: %llu queries found %llu pages, %llu installs, %llu wrong\n", what,
              static_cast<unsigned long long>(count.queries),
              static_cast<unsigned long long>(count.found),
              static_cast<unsigned long long>(count.installs),
              static_cast<unsigned long long>(count.wrong));
  return count.wrong == 0;
}

int run_weakened(const std::string& name) {
  const auto found = weakened_runs().find(name);
  if (found == weakened_runs().end()) return 2;
  constexpr std::uint64_t kQueries = 20'000'000, kInstalls = 2'000'000;
  const StressGoal goal{.queries = kQueries, .installs = kInstalls, .until_wrong = true};
  return report(name.c_str(), found->second(goal)) ? 0 : 1;
}

int run(std::uint64_t queries, std::uint64_t installs) {
  bool right = true;
  for (const std::uint32_t readers : {1u, 2u, 4u}) {
    const StressGoal goal{.readers = readers, .queries = queries, .installs = installs};
    const std::string what = "protocol, " + std::to_string(readers) + " readers";
    right &= report(what.c_str(), stress_protocol(goal));
  }
  // A fetch sleeps while a reader is stopped inside a section, so each thread needs a processor.
  const StressGoal goal{.readers = 1, .queries = queries, .installs = installs};
  right &= report("page cache, 1 reader", stress_page_cache(goal));
  return right ? 0 : 1;
}

}  // namespace
}  // namespace planetree::cache

int main(int argc, char** argv) {
  using namespace planetree::cache;
  const std::string word = argc > 1 ? argv[1] : "";
  if (argc == 2 && word == "--list") {
    for (const auto& [name, stress] : weakened_runs()) std::printf("%s\n", name.c_str());
    return 0;
  }
  if (argc == 3 && word == "--weakened") return run_weakened(argv[2]);
  if (argc == 1) return run(10'000'000, 1'000'000);
  if (argc == 3)
    return run(std::strtoull(argv[1], nullptr, 10), std::strtoull(argv[2], nullptr, 10));
  std::fprintf(stderr, "usage: check_threads [QUERIES INSTALLS | --weakened NAME | --list]\n");
  return 2;
}
