#pragma once

#include <string_view>

#include "planetree/types.h"

/// The rules of planetree/types.h for the answers of tolerant and hindered queries.
namespace planetree::oracle {

/// What is known of a query beside its answer.
struct JudgedQuery {
  Vec3 at;
  QueryOptions options;
  /// Answer of a blocking query for the same parts without limits, to the same file.
  ClosestPoint exact;
  bool has_region = false;  ///< of the model
  double size = 1;          ///< of the model, approximate
};

/// Returns the rule that an answer breaks; empty if it breaks none. Intervals are compared with
/// that of the exact answer, which they must meet.
std::string_view broken_rule(const JudgedQuery& query, const ClosestPoint& answer);

}  // namespace planetree::oracle
