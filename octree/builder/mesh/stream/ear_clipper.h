#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "octree/builder/mesh/stream/corner_grid.h"

namespace planetree::octree {

class PolygonProjection;

/// Three corners of a polygon by their numbers, in the orientation of the polygon.
using CornerTriple = std::array<std::uint32_t, 3>;

/// Splits simple polygons into triangles by cutting ears: triangles of three neighbouring corners
/// that no other part of the polygon reaches into. A polygon may touch itself, as where a bridge of
/// two equal edges joins a hole with the outline.
///
/// Order of the triangles: first spikes, corners where the outline turns back or stays in place,
/// are cut, from corner 0 on. Then ears are cut in rounds. The first round looks at all corners in
/// their order, each later one at the corners that lost a neighbour in the one before, in the order
/// of losing it. A corner that loses a neighbour waits for the next round; a spike that appears is
/// cut at once. If a round ends without any corner to look at, all that remain are looked at again;
/// if that cuts none, one corner on a straight line is cut, or else an ear that a corner touches.
/// The last triangle has the three corners that remain. A triangle names its ear second.
///
/// No triangle turns the wrong way, so that their union is the polygon if it winds at most once
/// around every point, which all simple polygons do.
///
/// source  Meisters 1975, "Polygons have ears"; Held 2001, "FIST"
class EarClipper {
 public:
  /// Splits a polygon of three or more corners.
  ///
  /// polygon    seen from the side from which it runs counterclockwise.
  /// has_area   false if its area is zero: it then consists of spikes or is refused.
  /// triangles  set to its triangles, two fewer than corners.
  /// return     whether the polygon could be split: a simple one can, unless its ears are not found
  ///            within a number of steps that grows with the number of corners.
  bool clip(const PolygonProjection& polygon, bool has_area, std::vector<CornerTriple>& triangles);
  /// Whether the last polygon took too many steps.
  [[nodiscard]] bool gave_up() const { return steps_ > max_steps_; }

 private:
  enum class Rule : std::uint8_t { kStrict, kStraight, kTouching };
  /// State of a corner.
  enum class Corner : std::uint8_t { kIdle, kWaiting, kCut };

  void start(const PolygonProjection& polygon);
  void fill_grid();
  bool cut_ears();
  bool run_round();
  bool cut_one(Rule rule);
  void wait_for_all();
  void cut(std::uint32_t ear);
  void cut_spikes();
  [[nodiscard]] bool is_spike(std::uint32_t corner) const;
  [[nodiscard]] int turn_at(std::uint32_t corner) const;
  void note_reflex(std::uint32_t corner);
  [[nodiscard]] bool may_cut(std::uint32_t ear, Rule rule);
  [[nodiscard]] bool is_ear(std::uint32_t ear, bool may_touch);
  [[nodiscard]] bool is_blocked_by(const CornerTriple& ear, std::uint32_t corner,
                                   bool may_touch) const;
  [[nodiscard]] CornerGrid::Position position(std::uint32_t corner) const;

  const PolygonProjection* polygon_ = nullptr;
  std::vector<CornerTriple>* triangles_ = nullptr;
  std::vector<std::uint32_t> before_, after_;  ///< neighbours of each corner
  std::vector<Corner> state_;
  std::vector<std::uint32_t> round_, next_round_;
  std::vector<std::uint32_t> unsettled_;  ///< corners that may have become spikes
  /// The reflex corners, and some that were: no other corner can be the only one in an ear's way.
  CornerGrid grid_;
  std::vector<bool> is_reflex_;
  std::vector<bool> in_grid_;
  std::size_t grid_corners_ = 0;  ///< corners that were left when the grid was filled
  std::size_t left_ = 0;          ///< corners that are not cut
  std::uint32_t some_left_ = 0;   ///< one of them
  std::uint64_t steps_ = 0;
  std::uint64_t max_steps_ = 0;
};

}  // namespace planetree::octree
