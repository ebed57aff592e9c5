// Makes queries with limits of error, distance, work and waiting to models that have a coarse
// field, and judges every answer.
// usage: check_intervals [COUNT [SEED]]
// COUNT answers are distributed over the models, default: ten million; below a thousand for each,
// some models are left out. Exit status 1 if any answer is wrong.

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "tests/soak/fielded_models.h"
#include "tests/soak/tolerant_queries.h"

namespace planetree::oracle {
namespace {

constexpr std::size_t kMinShare = 1000;       // answers of a model
constexpr std::size_t kMaxTriangles = 20000;  // of models that few answers are worth
constexpr std::size_t kOracleShare = 50;      // for models of a few thousand triangles

int run(std::size_t count, std::uint64_t seed) {
  const std::size_t models = std::clamp<std::size_t>(count / kMinShare, 1, kFieldedModels);
  const std::size_t share = count / models;
  IntervalTally all;
  std::printf("%-32s %9s %8s %8s %8s %8s %8s %8s %6s\n", "model", "answers", "proven", "exact",
              "within", "no tri.", "degraded", "beyond", "wrong");
  for (std::size_t i = 0; i < models; ++i) {
    // The number of models and the step have no common factor.
    FieldedModel model = fielded_model((i * 29 + seed) % kFieldedModels);
    if (share < 10 * kMinShare && model.triangles.size() > kMaxTriangles) continue;
    const std::string name = model.name;
    const std::size_t oracle_share = kOracleShare * (1 + model.triangles.size() / 5000);
    TolerantQueries queries(std::move(model), seed, oracle_share);
    const IntervalTally tally = queries.run(share);
    all += tally;
    std::printf("%-32s %9zu %8zu %8zu %8zu %8zu %8zu %8zu %6zu%s\n", name.c_str(), tally.answers,
                tally.proven, tally.exact, tally.within_error, tally.without_triangle,
                tally.degraded, tally.beyond, tally.wrong,
                queries.has_field() ? "" : "  (no field)");
    if (tally.wrong > 0) std::printf("  %s\n", tally.first_miss.c_str());
    std::fflush(stdout);
  }
  std::printf("%zu answers, %zu compared with every triangle, %zu without a triangle: %zu wrong\n",
              all.answers, all.proven, all.without_triangle, all.wrong);
  return all.wrong > 0 ? 1 : 0;
}

}  // namespace
}  // namespace planetree::oracle

int main(int count, char** arguments) {
  const auto number = [&](int at, std::size_t otherwise) {
    return count > at ? std::strtoull(arguments[at], nullptr, 10) : otherwise;
  };
  const std::size_t answers = number(1, 10000000);
  if (answers == 0 || count > 3) {
    std::fprintf(stderr, "usage: check_intervals [COUNT [SEED]]\n");
    return 2;
  }
  return planetree::oracle::run(answers, number(2, 0));
}
