#pragma once

#include <cstdint>

#include "planetree/types.h"
#include "query/serve/seq_lock.h"

namespace planetree::query {

/// A query that lacked pages: a real-time query, or a blocking one that gave up waiting. A fetch
/// thread makes the pages resident by running the query again as a blocking one. The members
/// besides `point` are those of QueryOptions.
struct FetchRequest {
  Vec3 point;  ///< model units
  double max_error = 0;
  double max_distance = 0;
  std::uint64_t max_work = 0;
  std::uint64_t parts = 0;
  std::uint64_t side_rule = 0;
  std::uint64_t normal_rule = 0;
  /// For a search for triangles: how many within which radius; 0: for the closest point.
  std::uint64_t triangles = 0;
  double radius = 0;
  /// For a search along a way from `point` by a ball of `radius`: whether it is one, and its end.
  /// `triangles` is then how many it may meet.
  std::uint64_t is_way = 0;
  Vec3 to;  ///< model units
};

/// Position and velocity of a probe, as given to Probe::motion.
struct Motion {
  Vec3 position;                ///< model units
  Vec3 velocity;                ///< model units per second
  std::uint64_t parts = 0;      ///< parts of the probe's last query
  std::uint64_t side_rule = 0;  ///< its side rule
  /// Number of the probe's closest-point queries so far that had to search for the side.
  std::uint64_t side_searches = 0;
};

/// What one probe leaves for fetch threads. The probe's thread stores, a fetch thread loads.
struct FetchRequests {
  SeqLock<FetchRequest> missed;
  SeqLock<Motion> motion;
};

}  // namespace planetree::query
