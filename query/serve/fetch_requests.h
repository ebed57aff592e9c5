#pragma once

#include <cstdint>

#include "planetree/types.h"
#include "query/serve/seq_lock.h"

namespace planetree::query {

/// A question that was answered without all the pages it needs: who asks it again, waiting for
/// them, makes them resident.
struct FetchRequest {
  Vec3 point;
  double max_error = 0;
  double max_distance = 0;
  std::uint64_t max_work = 0;
  std::uint64_t parts = 0;
};

/// Where a probe is and goes to, as its user says.
struct Motion {
  Vec3 position;
  Vec3 velocity;            ///< model units a second
  std::uint64_t parts = 0;  ///< of the probe's last ask
};

/// What one probe would like to have in memory.
struct FetchRequests {
  SeqLock<FetchRequest> missed;
  SeqLock<Motion> motion;
};

}  // namespace planetree::query
