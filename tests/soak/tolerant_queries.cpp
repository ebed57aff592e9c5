#include "tests/soak/tolerant_queries.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "tests/query/answer_bits.h"
#include "tests/query/least_memory.h"

namespace planetree::oracle {
namespace {

constexpr std::size_t kMaxGroup = 48;

template <class T>
T need(Result<T> result) {
  if (result) return std::move(*result);
  std::fprintf(stderr, "oracle: %s\n", result.error().text);
  std::abort();
}

Model open_with_least_memory(const std::filesystem::path& file) {
  OpenOptions options;
  options.locking = Locking::kNever;
  options.memory_budget_bytes = least_memory_bytes(file, options);
  return need(Model::open(file, options));
}

}  // namespace

IntervalTally& IntervalTally::operator+=(const IntervalTally& other) {
  answers += other.answers;
  proven += other.proven;
  exact += other.exact;
  within_error += other.within_error;
  degraded += other.degraded;
  beyond += other.beyond;
  without_triangle += other.without_triangle;
  wrong += other.wrong;
  if (first_miss.empty()) first_miss = other.first_miss;
  return *this;
}

TolerantQueries::TolerantQueries(FieldedModel model, std::uint64_t seed, std::size_t oracle_share)
    : model_(std::move(model)),
      built_(model_.triangles, model_.choices),
      intervals_(model_.triangles),
      places_(model_, built_),
      small_(open_with_least_memory(built_.path())),
      reference_(need(Probe::create(built_.model()))),
      single_(need(Probe::create(built_.model()))),
      of_small_(need(Probe::create(small_))),
      oracle_share_(oracle_share),
      random_(seed) {}

QueryOptions TolerantQueries::draw_options() {
  constexpr std::uint32_t kParts[] = {kDistance, kDistance, kDistance | kSide, kSide, kAllParts};
  constexpr SideRule kRules[] = {SideRule::kOfFile, SideRule::kOfFile, SideRule::kSolid,
                                 SideRule::kSurface};
  QueryOptions options;
  options.parts = kParts[random_.below(std::size(kParts))];
  options.side_rule = kRules[random_.below(std::size(kRules))];
  if (random_.one_in(4)) options.normal_rule = NormalRule::kTowardQuery;
  const double diagonal = 3.5 * model_.size;
  if (!random_.one_in(3)) options.max_error = diagonal * random_.magnitude(-30, 3.4);
  if (random_.one_in(3)) options.max_distance = diagonal * random_.magnitude(-20, 4);
  if (random_.one_in(3)) options.wait = Wait::kNever;
  if (random_.one_in(3))
    options.max_work = random_.one_in(8) ? 0 : static_cast<std::uint32_t>(random_.magnitude(0, 12));
  return options;
}

void TolerantQueries::draw_queries() {
  queries_.resize(1 + random_.below(kMaxGroup));
  const bool is_path = random_.one_in(3);
  for (std::size_t i = 0; i < queries_.size(); ++i)
    queries_[i] = is_path && i > 0 ? places_.next(random_) : places_.any(random_);
}

JudgedQuery TolerantQueries::judged(std::size_t query, const QueryOptions& options) const {
  JudgedQuery judged{queries_[query], options, exact_[query]};
  judged.has_region = built_.model().info().has_region;
  judged.size = model_.size;
  return judged;
}

void TolerantQueries::ask_singly(const QueryOptions& options) {
  Probe& probe = random_.one_in(3) ? of_small_ : single_;
  for (std::size_t i = 0; i < queries_.size(); ++i)
    judge(judged(i, options), probe.closest_point(queries_[i], options));
}

void TolerantQueries::ask_batches(const QueryOptions& options) {
  const bool in_little = random_.one_in(4);
  Probe& probe = in_little ? of_small_ : single_;
  probe.closest_points(queries_, answers_, options);
  for (std::size_t i = 0; i < queries_.size(); ++i) judge(judged(i, options), answers_[i]);
  if (options.wait == Wait::kNever) return;
  std::ranges::reverse(queries_);
  Probe& other = random_.one_in(4) ? of_small_ : single_;
  other.closest_points(queries_, again_, options);
  std::ranges::reverse(queries_);
  std::ranges::reverse(again_);
  for (std::size_t i = 0; i < queries_.size(); ++i) {
    ++tally_.answers;
    if (bits_of(answers_[i]) != bits_of(again_[i]))
      miss(judged(i, options), again_[i], "a batch in another order has other bits");
  }
}

IntervalTally TolerantQueries::run(std::size_t count) {
  tally_ = {};
  while (tally_.answers < count) {
    draw_queries();
    for (auto* answers : {&exact_, &answers_, &again_}) answers->assign(queries_.size(), {});
    QueryOptions options = draw_options();
    QueryOptions unlimited = options;
    unlimited.wait = Wait::kForPages;
    unlimited.max_work = QueryOptions::kNoLimit;
    unlimited.max_error = 0;
    unlimited.max_distance = QueryOptions().max_distance;
    for (std::size_t i = 0; i < queries_.size(); ++i)
      exact_[i] = reference_.closest_point(queries_[i], unlimited);
    // Limits as near to a distance as can be.
    if (random_.one_in(6) && std::isfinite(exact_[0].distance))
      options.max_distance = std::nextafter(exact_[0].distance, random_.one_in(2) ? 0 : 1e300);
    random_.one_in(2) ? ask_singly(options) : ask_batches(options);
  }
  return tally_;
}

bool TolerantQueries::is_proven(const JudgedQuery& query, const ClosestPoint& answer) const {
  if (!intervals_.none_nearer(query.at, answer.lower)) return false;
  if (query.exact.triangle != kNoTriangle &&
      intervals_.reaches(query.at, query.exact.triangle, answer.upper))
    return true;
  for (std::size_t i = 0; i < model_.triangles.size(); ++i)
    if (intervals_.reaches(query.at, i, answer.upper)) return true;
  return false;
}

void TolerantQueries::judge(const JudgedQuery& query, const ClosestPoint& answer) {
  ++tally_.answers;
  tally_.exact += answer.status == Status::kExact;
  tally_.degraded += answer.status == Status::kDegraded;
  tally_.beyond += answer.status == Status::kBeyondMaxDistance;
  if (answer.status == Status::kWithinError) {
    ++tally_.within_error;
    tally_.without_triangle += answer.triangle == kNoTriangle;
  }
  const std::string_view rule = broken_rule(query, answer);
  if (!rule.empty()) return miss(query, answer, rule);
  if (!(answer.lower > 0 || answer.upper < HUGE_VAL) || !random_.one_in(oracle_share_)) return;
  ++tally_.proven;
  if (!is_proven(query, answer)) miss(query, answer, "the interval does not hold the distance");
}

void TolerantQueries::miss(const JudgedQuery& query, const ClosestPoint& answer,
                           std::string_view rule) {
  ++tally_.wrong;
  if (!tally_.first_miss.empty()) return;
  const auto number = [](auto value) { return static_cast<unsigned>(value); };
  const QueryOptions& options = query.options;
  const ClosestPoint& exact = query.exact;
  char line[900];
  std::snprintf(
      line, sizeof line,
      "%s: %.*s: query %a %a %a, parts %u, side rule %u, normal rule %u, wait %u, work %u, error "
      "%a, limit %a: distance %a in [%a, %a], point %a %a %a, triangle %lld, side %u, normal %g "
      "%g %g, status %u; exact: distance %a in [%a, %a], triangle %lld, side %u, status %u",
      model_.name.c_str(), static_cast<int>(rule.size()), rule.data(), query.at.x, query.at.y,
      query.at.z, options.parts, number(options.side_rule), number(options.normal_rule),
      number(options.wait), options.max_work, options.max_error, options.max_distance,
      answer.distance, answer.lower, answer.upper, answer.point.x, answer.point.y, answer.point.z,
      static_cast<long long>(answer.triangle), number(answer.side), answer.normal.x,
      answer.normal.y, answer.normal.z, number(answer.status), exact.distance, exact.lower,
      exact.upper, static_cast<long long>(exact.triangle), number(exact.side),
      number(exact.status));
  tally_.first_miss = line;
}

}  // namespace planetree::oracle
