#include "octree/builder/mesh/stream/ear_clipper.h"

#include <utility>

#include "octree/builder/mesh/stream/polygon_projection.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

/// Steps that a polygon may take: cells and corners that are looked at.
constexpr std::uint64_t kMinSteps = std::uint64_t{1} << 22;
constexpr std::uint64_t kStepsPerCorner = 4096;

}  // namespace

bool EarClipper::clip(const PolygonProjection& polygon, bool has_area,
                      std::vector<CornerTriple>& triangles) {
  triangles_ = &triangles;
  start(polygon);
  for (std::uint32_t k = 0; k < polygon.size(); ++k) {
    unsettled_.push_back(k);
    cut_spikes();
  }
  if (left_ > 3 && !(has_area && cut_ears())) return false;
  const std::uint32_t last = after_[some_left_];
  triangles.push_back({some_left_, last, after_[last]});
  return polygon.turn(some_left_, last, after_[last]) >= 0;
}

void EarClipper::start(const PolygonProjection& polygon) {
  polygon_ = &polygon;
  const auto count = static_cast<std::uint32_t>(polygon.size());
  triangles_->clear();
  triangles_->reserve(count - 2);
  before_.resize(count);
  after_.resize(count);
  for (std::uint32_t k = 0; k < count; ++k) {
    before_[k] = k == 0 ? count - 1 : k - 1;
    after_[k] = k + 1 == count ? 0 : k + 1;
  }
  state_.assign(count, Corner::kIdle);
  round_.clear();
  next_round_.clear();
  unsettled_.clear();
  grid_corners_ = 0;
  left_ = count;
  some_left_ = 0;
  steps_ = 0;
  max_steps_ = kMinSteps + kStepsPerCorner * count;
}

CornerGrid::Position EarClipper::position(std::uint32_t corner) const {
  return {polygon_->u(corner), polygon_->v(corner)};
}

void EarClipper::fill_grid() {
  const CornerGrid::Position first = position(some_left_);
  CornerGrid::Box box{first, first};
  std::uint32_t corner = some_left_;
  for (std::size_t i = 0; i < left_; ++i, corner = after_[corner]) box.extend(position(corner));
  grid_.start(box, left_);
  grid_corners_ = left_;
  is_reflex_.assign(polygon_->size(), false);
  in_grid_.assign(polygon_->size(), false);
  for (std::size_t i = 0; i < left_; ++i, corner = after_[corner]) note_reflex(corner);
  steps_ += left_;
}

void EarClipper::note_reflex(std::uint32_t corner) {
  is_reflex_[corner] = turn_at(corner) < 0;
  if (!is_reflex_[corner] || in_grid_[corner]) return;
  in_grid_[corner] = true;
  grid_.add(corner, static_cast<std::uint32_t>(polygon_->size()), position(corner));
}

bool EarClipper::cut_ears() {
  fill_grid();
  wait_for_all();
  while (left_ > 3) {
    if (gave_up()) return false;
    if (run_round() || !next_round_.empty()) continue;
    // Nothing waits: what was cut may have opened the way for others.
    wait_for_all();
    if (run_round() || left_ == 3) continue;
    if (!cut_one(Rule::kStraight) && !cut_one(Rule::kTouching)) return false;
  }
  return true;
}

void EarClipper::wait_for_all() {
  next_round_.clear();
  std::uint32_t corner = some_left_;
  for (std::size_t i = 0; i < left_; ++i, corner = after_[corner]) {
    state_[corner] = Corner::kWaiting;
    next_round_.push_back(corner);
  }
}

// Returns whether a corner was cut.
bool EarClipper::run_round() {
  const std::size_t before = left_;
  std::swap(round_, next_round_);
  next_round_.clear();
  for (const std::uint32_t corner : round_)
    if (state_[corner] == Corner::kWaiting) state_[corner] = Corner::kIdle;
  for (const std::uint32_t corner : round_) {
    if (left_ == 3 || gave_up()) break;
    if (state_[corner] == Corner::kIdle && may_cut(corner, Rule::kStrict)) {
      cut(corner);
      cut_spikes();
    }
  }
  return left_ < before;
}

bool EarClipper::cut_one(Rule rule) {
  std::uint32_t corner = some_left_;
  for (std::size_t i = 0; i < left_; ++i, corner = after_[corner])
    if (may_cut(corner, rule)) {
      cut(corner);
      cut_spikes();
      return true;
    }
  return false;
}

void EarClipper::cut(std::uint32_t ear) {
  const std::uint32_t a = before_[ear], c = after_[ear];
  triangles_->push_back({a, ear, c});
  after_[a] = c;
  before_[c] = a;
  state_[ear] = Corner::kCut;
  --left_;
  if (ear == some_left_) some_left_ = c;
  for (const std::uint32_t neighbour : {c, a}) {
    if (grid_corners_ > 0) note_reflex(neighbour);
    unsettled_.push_back(neighbour);
    if (state_[neighbour] == Corner::kWaiting) continue;
    state_[neighbour] = Corner::kWaiting;
    next_round_.push_back(neighbour);
  }
}

void EarClipper::cut_spikes() {
  while (!unsettled_.empty()) {
    const std::uint32_t corner = unsettled_.back();
    unsettled_.pop_back();
    if (left_ > 3 && state_[corner] != Corner::kCut && is_spike(corner)) cut(corner);
  }
}

int EarClipper::turn_at(std::uint32_t corner) const {
  return polygon_->turn(before_[corner], corner, after_[corner]);
}

bool EarClipper::is_spike(std::uint32_t corner) const {
  return turn_at(corner) == 0 && !polygon_->is_between(before_[corner], corner, after_[corner]);
}

bool EarClipper::may_cut(std::uint32_t ear, Rule rule) {
  ++steps_;
  const int turn = turn_at(ear);
  if (rule == Rule::kStraight) return turn == 0;
  return turn > 0 && is_ear(ear, rule == Rule::kTouching);
}

bool EarClipper::is_ear(std::uint32_t ear, bool may_touch) {
  const CornerTriple corners = {before_[ear], ear, after_[ear]};
  if (left_ < grid_corners_ / 2) fill_grid();
  return !grid_.any_near({position(corners[0]), position(ear), position(corners[2])}, steps_,
                         [&](std::uint32_t corner) {
                           return is_reflex_[corner] && state_[corner] != Corner::kCut &&
                                  is_blocked_by(corners, corner, may_touch);
                         });
}

// A corner blocks an ear if it is inside or on the side that would be cut, or if an edge goes from
// it through the inside.
bool EarClipper::is_blocked_by(const CornerTriple& ear, std::uint32_t corner,
                               bool may_touch) const {
  std::array<bool, 3> on{};
  for (std::size_t k = 0; k < 3; ++k) {
    const int turn = polygon_->turn(ear[k], ear[(k + 1) % 3], corner);
    if (turn < 0) return false;
    on[k] = turn == 0;
  }
  const auto [on_first, on_second, on_cut] = on;
  if (!on_first && !on_second && (!on_cut || !may_touch)) return true;
  for (const std::uint32_t other : {before_[corner], after_[corner]}) {
    bool goes_inside = true;
    for (std::size_t k = 0; k < 3 && goes_inside; ++k)
      goes_inside = !on[k] || polygon_->turn(ear[k], ear[(k + 1) % 3], other) > 0;
    if (goes_inside) return true;
  }
  return false;
}

}  // namespace planetree::octree
