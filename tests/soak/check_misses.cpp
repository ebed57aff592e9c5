// Compares the misses of the engine with those that a replay of its page lookups says, on glide,
// scratch, teleport and a batch, with every policy, within 8 budgets. Exit status 1 if any differ.

#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "planetree/model.h"
#include "tests/tools/tune/engine_run.h"
#include "tools/cli/policy_option.h"

namespace planetree::tools {
namespace {

constexpr std::size_t kBudgets = 8;

/// Prints the misses of a kind of work. Returns how many runs differ or beat the optimum.
int compare(const char* name, const EngineWork& work, std::uint64_t most) {
  int wrong = 0;
  fmt::print("{}, {} queries\n{:>10}{:>10}{:>12}{:>12}{:>12}\n", name, work.points.size(), "policy",
             "frames", "engine", "replayed", "optimum");
  for (const EngineComparison& compared : compare_engine(work, kBudgets, most)) {
    const bool is_wrong =
        compared.replayed != compared.engine || compared.optimum > compared.engine;
    wrong += is_wrong;
    fmt::print("{:>10}{:>10}{:>12}{:>12}{:>12}{}\n", name_of(compared.policy), compared.frames,
               compared.engine, compared.replayed, compared.optimum, is_wrong ? "  WRONG" : "");
  }
  return wrong;
}

int check(const std::string& model, std::size_t queries) {
  std::uint64_t most = 0;
  {
    const auto opened = Model::open(model, {.max_probes = 1});
    if (!opened) {
      fmt::print(stderr, "{}: {}\n", model, opened.error().text);
      return 1;
    }
    // A quarter of the memory of all pages, as far as the default budget goes.
    most = opened->stats().table_bytes + opened->stats().arena_bytes / 4;
  }
  int wrong = 0;
  std::vector<Vec3> all;
  for (const TouchMotion motion : kAllTouchMotions) {
    const std::vector<Vec3> path = engine_path(model, motion, queries);
    all.insert(all.end(), path.begin(), path.end());
    wrong += compare(name_of(motion), {model, path, false}, most);
  }
  wrong += compare("batch", {model, all, true}, most);
  fmt::print("{} of {} runs differ from their replay or beat the optimum\n", wrong,
             4 * kBudgets * std::size(kAllPolicies));
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace planetree::tools

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: check_misses MODEL [QUERIES]\n");
    return 2;
  }
  return planetree::tools::check(argv[1], argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 20'000);
}
