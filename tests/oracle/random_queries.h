#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "tests/oracle/built_model.h"
#include "tests/oracle/random.h"

/// Random questions to nasty models, many of them, judged without googletest.
namespace planetree::oracle {

inline constexpr std::size_t kQueriedModels = 40;

/// The family that model `number` is of.
std::string_view name_of(std::size_t number);

/// One of kQueriedModels models of at most 500 triangles of every nasty and every
/// closed family, at scales from 1e-300 to 1e150.
struct QueriedModel {
  explicit QueriedModel(std::size_t number);

  std::string_view family;
  bool closed;   ///< of a family whose models are watertight
  double scale;  ///< its size, about
  Random random;
  BuiltModel built;

  /// As nasty_query(), and besides anywhere in its box, lattice points, and
  /// points so far off that squares overflow.
  Vec3 query();
};

/// What was asked and what went wrong.
struct QueryTally {
  std::size_t queries = 0;
  std::size_t sides = 0;    ///< told, and compared
  std::size_t normals = 0;  ///< compared with the side
  std::size_t not_finite = 0, interval = 0, side = 0, normal = 0;
  std::string first_miss;

  [[nodiscard]] std::size_t misses() const { return not_finite + interval + side + normal; }
  QueryTally& operator+=(const QueryTally& other);
};

/// Queries model `number` `count` times. Wrong is a number that is not finite; an
/// interval without the truth; a side other than the exact one, or none from a
/// watertight model; a normal that is not of length 1, or points into the solid
/// where the way from the nearest point to the query can be told from rounding.
QueryTally query_at_random(std::size_t number, std::size_t count);

}  // namespace planetree::oracle
