#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "tests/oracle/interval_oracle.h"
#include "tests/soak/field_places.h"
#include "tests/soak/interval_judge.h"

/// Many queries with limits of error, distance, work and waiting, alone and together, judged
/// without googletest.
namespace planetree::oracle {

/// Numbers of answers, and of faults among them.
struct IntervalTally {
  std::size_t answers = 0;
  std::size_t proven = 0;  ///< intervals compared with every triangle
  std::size_t exact = 0, within_error = 0, degraded = 0, beyond = 0;
  std::size_t without_triangle = 0;  ///< answers within an error that have none
  std::size_t wrong = 0;
  std::string first_miss;

  IntervalTally& operator+=(const IntervalTally& other);
};

/// Queries of one model.
class TolerantQueries {
 public:
  /// A failure ends the test program with a message. Every oracle_share-th answer is compared with
  /// every triangle.
  TolerantQueries(FieldedModel model, std::uint64_t seed, std::size_t oracle_share);

  /// Makes at least `count` queries. Some are single ones, with much memory or with the least; some
  /// are batches, which are made again in the reverse order and must have the same bits.
  IntervalTally run(std::size_t count);

  [[nodiscard]] bool has_field() const { return built_.record().field_page_count > 0; }

 private:
  void draw_queries();
  QueryOptions draw_options();
  void ask_singly(const QueryOptions& options);
  void ask_batches(const QueryOptions& options);
  void judge(const JudgedQuery& query, const ClosestPoint& answer);
  void miss(const JudgedQuery& query, const ClosestPoint& answer, std::string_view rule);
  [[nodiscard]] bool is_proven(const JudgedQuery& query, const ClosestPoint& answer) const;
  [[nodiscard]] JudgedQuery judged(std::size_t query, const QueryOptions& options) const;

  const FieldedModel model_;
  BuiltModel built_;
  IntervalOracle intervals_;
  FieldPlaces places_;
  Model small_;
  Probe reference_, single_, of_small_;
  const std::size_t oracle_share_;
  Random random_;
  std::vector<Vec3> queries_;
  std::vector<ClosestPoint> exact_, answers_, again_;
  IntervalTally tally_;
};

}  // namespace planetree::oracle
