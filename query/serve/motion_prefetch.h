#pragma once

#include <chrono>
#include <cstdint>
#include <span>

#include "planetree/types.h"
#include "query/serve/fetch_requests.h"

namespace planetree::query {

/// Chooses the positions ahead of one moving probe whose pages are prefetched: those that the probe
/// reaches within a horizon if it goes on as it does, the next one first. One thread at a time may
/// use it.
///
/// - The horizon covers twice the time that a fetch takes and twice the time from motion to motion.
/// - All positions but the last are those of a probe that goes on turning as it turned between the
///   last two motions. The last one is straight ahead, because errors of the turn grow with the
///   square of the time.
/// - A probe that is suddenly much faster was moved elsewhere. Its motion predicts nothing and is
///   left out.
/// - Queries of a probe that goes along the surface seldom search for the side: faces or the last
///   side tell it. Such a search reads pages of the mask over a wide area. So prefetches search for
///   sides only if queries of the probe lately did.
class MotionPrefetch {
 public:
  using Seconds = std::chrono::duration<double>;

  /// Number of positions ahead of a motion.
  static constexpr unsigned kPositions = 4;
  /// Limits of the horizon.
  static constexpr Seconds kMinHorizon{0.005}, kMaxHorizon{0.6};
  /// A motion more than this many times as fast as the one before it is left out.
  static constexpr double kMaxSpeedUp = 4;
  /// Number of motions after a search for a side in which prefetches search for sides.
  static constexpr std::uint32_t kMotionsAfterSearch = 16;

  /// A position to prefetch.
  struct Ahead {
    Vec3 position;            ///< model units
    bool searches_side;       ///< whether to read the pages that a search for the side needs
    std::uint64_t parts;      ///< parts of the probe's last query
    std::uint64_t side_rule;  ///< its side rule
  };

  /// Takes a newer motion. It replaces the positions that are left.
  ///
  /// now  time of any clock that does not go back
  void take(const Motion& motion, Seconds now) noexcept;

  bool has_next() const noexcept { return left_ > 0; }
  /// Returns the next position. Needs has_next().
  ///
  /// fetch_time  time that a fetch takes
  Ahead next(Seconds fetch_time) noexcept;
  /// Returns the positions that next() has not returned, in the same order.
  ///
  /// positions  receives them; at least kPositions
  std::span<const Vec3> left(Seconds fetch_time, std::span<Vec3> positions) const noexcept;

 private:
  static bool is_as_fast(const Motion& motion, const Motion& other) noexcept;
  void compare_with_last(const Motion& motion, Seconds now) noexcept;
  Vec3 position(unsigned number, Seconds fetch_time) const noexcept;
  Vec3 turned(Seconds time) const noexcept;

  Motion motion_;  // the last one
  Vec3 change_;    // of the velocity since the motion before it
  bool has_motion_ = false;
  unsigned left_ = 0;  // number of positions
  std::uint32_t motions_since_search_ = kMotionsAfterSearch;
  Seconds taken_at_{0};
  Seconds interval_{0};  // decaying mean of the time from motion to motion
};

}  // namespace planetree::query
