// Holds answers that did not wait for pages against ones that did.
// usage: check_real_time MODEL.ptree [ASKS]
//
// Budgets of 5, 10, 25 and 50 % of what the whole model takes, each way that a tip moves: every
// interval must hold the true distance, and an answer that calls itself exact must be the exact
// one to the last bit. Exit status 1 if any is wrong.

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "tests/query/answer_bits.h"
#include "tools/touch_path.h"

namespace planetree::oracle {
namespace {

using tools::TouchMotion;

struct Count {
  std::size_t asked = 0, degraded = 0, wrong = 0;
};

bool agrees(const ClosestPoint& answer, const ClosestPoint& exact) {
  if (answer.status == Status::kExact) return bits_of(answer) == bits_of(exact);
  const bool side = answer.side == Side::kUnknown || answer.side == exact.side;
  return answer.status == Status::kDegraded && side && answer.lower <= exact.upper &&
         answer.upper >= exact.lower && answer.distance >= exact.lower;
}

Count check(const std::string& file, std::uint64_t budget_bytes, const std::vector<Vec3>& path,
            const std::vector<ClosestPoint>& exact) {
  OpenOptions options;
  options.memory_budget_bytes = budget_bytes;
  options.max_probes = 1;
  const auto model = Model::open(file, options);
  if (!model) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), model.error().text);
    std::exit(1);
  }
  auto probe = Probe::create(*model);
  Count count;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const ClosestPoint answer = probe->closest_point(path[i], {.wait = Wait::kNever});
    ++count.asked;
    count.degraded += answer.status == Status::kDegraded;
    count.wrong += !agrees(answer, exact[i]);
  }
  return count;
}

int run(const std::string& file, std::size_t asks) {
  OpenOptions roomy;
  roomy.memory_budget_bytes = ~std::uint64_t{0} / 2;
  roomy.locking = Locking::kNever;
  const auto model = Model::open(file, roomy);
  if (!model) {
    std::fprintf(stderr, "%s: %s\n", file.c_str(), model.error().text);
    return 1;
  }
  auto probe = Probe::create(*model);
  const std::uint64_t whole = model->stats().arena_bytes + model->stats().table_bytes;
  std::size_t wrong = 0;
  for (const TouchMotion motion : tools::kAllTouchMotions) {
    const std::vector<Vec3> path = tools::touch_path(*model, *probe, motion, asks / 12);
    std::vector<ClosestPoint> exact(path.size());
    probe->closest_points(path, exact);
    for (const unsigned percent : {5u, 10u, 25u, 50u}) {
      const Count count = check(file, whole * percent / 100, path, exact);
      std::printf("%-9s %3u %% of memory: %zu asks, %zu degraded, %zu wrong\n", name_of(motion),
                  percent, count.asked, count.degraded, count.wrong);
      wrong += count.wrong;
    }
  }
  return wrong > 0;
}

}  // namespace
}  // namespace planetree::oracle

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: check_real_time MODEL.ptree [ASKS]\n");
    return 2;
  }
  return planetree::oracle::run(argv[1], argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1000000);
}
