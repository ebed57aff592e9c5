#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "tests/oracle/built_model.h"
#include "tests/oracle/random.h"

/// Many random queries to nasty models, judged without googletest.
namespace planetree::oracle {

inline constexpr std::size_t kQueriedModels = 40;

/// Name of the family of model `number`.
std::string_view name_of(std::size_t number);

/// One of kQueriedModels models of at most 500 triangles. They cover every nasty and every closed
/// family, at scales from 1e-300 to 1e150.
struct QueriedModel {
  explicit QueriedModel(std::size_t number);

  std::string_view family;
  bool closed;   ///< of a family of watertight models
  double scale;  ///< approximate size
  Random random;
  BuiltModel built;

  /// Returns a query: as nasty_query(), anywhere in the model's box, a lattice point, or so far off
  /// that squares overflow.
  Vec3 query();
};

/// Numbers of queries made and of faults found.
struct QueryTally {
  std::size_t queries = 0;
  std::size_t sides = 0;          ///< sides compared with the true side
  std::size_t normals = 0;        ///< normals compared with the side
  std::size_t limited_exact = 0;  ///< exact answers of limited queries
  std::size_t not_finite = 0, interval = 0, side = 0, normal = 0, limited = 0;
  std::string first_miss;

  [[nodiscard]] std::size_t misses() const {
    return not_finite + interval + side + normal + limited;
  }
  QueryTally& operator+=(const QueryTally& other);
};

/// Makes `count` queries to model `number`. Faults are: a number that is not finite; an interval
/// that does not hold the true distance; a side other than the exact one, or an unknown side of a
/// watertight model; a normal that is not of length 1, or that points into the solid where the
/// direction from the nearest point to the query exceeds rounding; an answer to the same query with
/// limited work, or to one that does not wait, that does not agree (LimitedQueries).
QueryTally query_at_random(std::size_t number, std::size_t count);

}  // namespace planetree::oracle
