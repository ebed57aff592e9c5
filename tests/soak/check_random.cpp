// Makes random queries to nasty models and judges every answer.
// usage: check_random [COUNT]
// COUNT queries are distributed over the models; default: a million. Each is made again with
// limited work, or without waiting. Exit status 1 if any answer is wrong.

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "tests/oracle/random_queries.h"

int main(int count, char** arguments) {
  using namespace planetree::oracle;
  const auto queries =
      static_cast<std::size_t>(count > 1 ? std::strtoull(arguments[1], nullptr, 10) : 1000000);
  if (queries == 0) {
    std::fprintf(stderr, "usage: check_random [COUNT]\n");
    return 2;
  }
  QueryTally all;
  std::printf("%-20s %8s %8s %8s %8s | misses: finite interval side normal limited\n", "model",
              "queries", "sides", "normals", "limited");
  for (std::size_t model = 0; model < kQueriedModels; ++model) {
    const std::size_t share = (queries + kQueriedModels - 1) / kQueriedModels;
    const QueryTally tally = query_at_random(model, share);
    all += tally;
    std::printf("%-20.*s %8zu %8zu %8zu %8zu | %zu %zu %zu %zu %zu\n",
                static_cast<int>(name_of(model).size()), name_of(model).data(), tally.queries,
                tally.sides, tally.normals, tally.limited_exact, tally.not_finite, tally.interval,
                tally.side, tally.normal, tally.limited);
    std::fflush(stdout);
  }
  if (all.misses() > 0) std::printf("%s\n", all.first_miss.c_str());
  std::printf("%zu queries, %zu sides, %zu normals: %zu wrong\n", all.queries, all.sides,
              all.normals, all.misses());
  return all.misses() > 0 ? 1 : 0;
}
