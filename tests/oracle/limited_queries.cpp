#include "tests/oracle/limited_queries.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "octree/traversal/tree_walk.h"
#include "query/model_state.h"
#include "query/serve/page_accessor.h"
#include "tests/query/answer_bits.h"
#include "tests/query/least_memory.h"

namespace planetree::oracle {
namespace {

constexpr std::uint64_t kMuchMemory = std::uint64_t{1} << 32;

template <class T>
T need(Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "oracle: %s\n", result.error().text);
  std::abort();
}

Model open(const std::filesystem::path& file, bool least) {
  OpenOptions options;
  options.max_probes = 3;
  options.locking = Locking::kNever;
  options.memory_budget_bytes = least ? least_memory_bytes(file, options) : kMuchMemory;
  return need(Model::open(file, options));
}

QueryOptions limited_options(Random& random) {
  constexpr std::uint32_t kParts[] = {kDistance, kSide, kDistance | kSide, kAllParts, kAllParts};
  constexpr SideRule kRules[] = {SideRule::kOfFile, SideRule::kOfFile, SideRule::kSolid,
                                 SideRule::kSurface};
  QueryOptions options;
  options.parts = kParts[random.below(std::size(kParts))];
  options.side_rule = kRules[random.below(std::size(kRules))];
  if (random.one_in(4)) options.normal_rule = NormalRule::kTowardQuery;
  if (random.one_in(2)) options.wait = Wait::kNever;
  const auto work = static_cast<std::uint32_t>(random.magnitude(0, 12));
  if (options.wait == Wait::kForPages || random.one_in(2)) options.max_work = work;
  return options;
}

std::string words(const Vec3& query, const QueryOptions& options, const ClosestPoint& answer,
                  const ClosestPoint& exact) {
  char line[600];
  const auto number = [](auto value) { return static_cast<unsigned>(value); };
  std::snprintf(
      line, sizeof line,
      "query %a %a %a, parts %u, side rule %u, normal rule %u, wait %u, work %u: distance %a in "
      "[%a, %a], triangle %llu, side %u, normal %g %g %g, status %u; exact: distance %a in [%a, "
      "%a], triangle %llu, side %u, normal %g %g %g, status %u",
      query.x, query.y, query.z, options.parts, number(options.side_rule),
      number(options.normal_rule), number(options.wait), options.max_work, answer.distance,
      answer.lower, answer.upper, static_cast<unsigned long long>(answer.triangle),
      number(answer.side), answer.normal.x, answer.normal.y, answer.normal.z, number(answer.status),
      exact.distance, exact.lower, exact.upper, static_cast<unsigned long long>(exact.triangle),
      number(exact.side), exact.normal.x, exact.normal.y, exact.normal.z, number(exact.status));
  return line;
}

}  // namespace

bool agrees(const ClosestPoint& answer, const ClosestPoint& exact) {
  if (answer.status == Status::kExact) return bits_of(answer) == bits_of(exact);
  const bool side = answer.side == Side::kUnknown || answer.side == exact.side;
  return answer.status == Status::kDegraded && side && answer.lower <= exact.upper &&
         answer.upper >= exact.lower && answer.distance >= exact.lower;
}

LimitedQueries::LimitedQueries(const std::filesystem::path& file)
    : large_(open(file, false)),
      small_(open(file, true)),
      reference_(need(Probe::create(large_))),
      of_large_(need(Probe::create(large_))),
      of_small_(need(Probe::create(small_))) {}

bool LimitedQueries::agree(const Vec3& query, Random& random) {
  const QueryOptions options = limited_options(random);
  QueryOptions unlimited = options;
  unlimited.wait = Wait::kForPages;
  unlimited.max_work = QueryOptions::kNoLimit;
  Probe& probe = random.one_in(3) ? of_large_ : of_small_;
  const ClosestPoint answer = probe.closest_point(query, options);
  const ClosestPoint exact = reference_.closest_point(query, unlimited);
  bool good = agrees(answer, exact);
  exact_ += answer.status == Status::kExact;
  if (options.parts == kSide) {
    const Containment alone = probe.contains(query, options);
    good = good && (alone.side == Side::kUnknown
                        ? alone.status == Status::kDegraded
                        : alone.status == Status::kExact && alone.side == exact.side);
  }
  if (!good) last_miss_ = words(query, options, answer, exact);
  return good;
}

std::vector<Corners> LimitedQueries::caps() const {
  const query::ModelState& state = query::ModelState::of(large_);
  const query::ModelGeometry& geometry = state.geometry();
  std::vector<Corners> caps;
  if (!geometry.tree.caps) return caps;
  cache::Reader reader = need(state.claim_reader());
  query::PageAccessor accessor(reader, Wait::kForPages);
  octree::TraversalStats work;
  octree::BoxWalk(geometry.caps, geometry.tree.box_lower, geometry.tree.box_upper, accessor.pages(),
                  work)
      .run(octree::WorkLimit::kNone, [&](const octree::BlockView& block, std::uint32_t) {
        for (unsigned i = 0; i < block.triangle_count(); ++i) {
          const auto [a, b, c] = block.triangle(i);
          caps.push_back({geometry.scale.out(a), geometry.scale.out(b), geometry.scale.out(c)});
        }
      });
  return caps;
}

}  // namespace planetree::oracle
