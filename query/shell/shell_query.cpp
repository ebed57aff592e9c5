#include "query/shell/shell_query.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/strict_math.h"
#include "query/shell/vectors.h"

namespace planetree::query {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Allowed error of the distance of a sphere's centre, as a share of its radius. The coarse field
// answers most such queries without a page.
constexpr double kCentreError = 0.5;
// How far beyond the distance that matters a query looks, in radii of a leaf or of the sphere: what
// is found there need not be asked again until the tool has moved so far.
constexpr double kLookAhead = 2;

SideRule side_rule_of(const ShellOptions& options, const ModelInfo& model) {
  return options.side_rule == SideRule::kOfFile ? model.side_rule : options.side_rule;
}

SignRule sign_rule_of(const ShellOptions& options, SideRule side_rule, const ModelInfo& model) {
  if (options.depth_rule == DepthRule::kTwoSided) return SignRule::kUnsigned;
  return model.watertight() && side_rule == SideRule::kSolid ? SignRule::kContinuous
                                                             : SignRule::kByPoint;
}

std::uint64_t limit_of(const ShellOptions& options) {
  if (options.max_work != QueryOptions::kNoLimit) return options.max_work;
  return options.wait == Wait::kNever ? ShellOptions::kRealTimeWork
                                      : std::numeric_limits<std::uint64_t>::max();
}

}  // namespace

ShellQuery::ShellQuery(Probe& probe, ShellMemory& memory, const octree::RigidTransform& transform,
                       const ShellOptions& options)
    : probe_(probe),
      memory_(memory),
      tree_(memory.tree),
      transform_(transform),
      options_(options),
      side_rule_(side_rule_of(options, memory.model)),
      sign_rule_(sign_rule_of(options, side_rule_, memory.model)),
      is_limited_(limit_of(options) != std::numeric_limits<std::uint64_t>::max()),
      max_work_(limit_of(options)),
      position_error_(transform.position_error(tree_.reach())) {
  const double diagonal = upper_length(memory.model.box_upper - memory.model.box_lower);
  const double deepest = options.max_depth - options.margin;
  free_ = options.margin + octree::kShellSlack * (options.margin + diagonal);
  full_ = -deepest - octree::kShellSlack * (std::fabs(deepest) + diagonal);
  // A point as deep as max_depth still needs the model's normal.
  if (options.force_direction == ForceDirection::kModelNormal) full_ = -kInfinity;
  // What lies beyond is free, or full, by more than rounding.
  const double beyond = 2 * position_error_ + octree::kShellSlack * (options.margin + diagonal);
  free_search_ = free_ + beyond;
  full_search_ = std::max(free_search_, beyond - full_);
  memory.begin(sign_rule_, side_rule_);
}

void ShellQuery::run() {
  memory_.bounds[0] = {};
  memory_.queue.push_back(0);
  for (std::size_t i = 0; i < memory_.queue.size(); ++i) examine(memory_.queue[i]);
  std::ranges::sort(memory_.leaves, [](const ShellMemory::Leaf& a, const ShellMemory::Leaf& b) {
    return a.lowest != b.lowest ? a.lowest < b.lowest : a.node < b.node;
  });
  for (const ShellMemory::Leaf& leaf : memory_.leaves)
    examine_points(tree_.nodes()[leaf.node], memory_.bounds[leaf.node]);
}

ClosestPoint ShellQuery::ask(const Vec3& at, QueryOptions options) {
  options.wait = options_.wait;
  options.side_rule = side_rule_;
  const std::uint64_t left = max_work_ - std::min(work_, max_work_);
  if (is_limited_) options.max_work = static_cast<std::uint32_t>(left);
  const std::uint64_t before = probe_.work_spent();
  const ClosestPoint answer = probe_.closest_point(at, options);
  const std::uint64_t spent = std::max<std::uint64_t>(1, probe_.work_spent() - before);
  work_ += is_limited_ ? std::min(spent, left) : spent;
  ++queries_;
  return answer;
}

void ShellQuery::examine(std::uint32_t index) {
  const Node& node = tree_.nodes()[index];
  const Vec3 centre = transform_.apply(node.centre);
  // The true points are within radius + error of the computed centre, and the computed points
  // within twice the error. Their answers err once more.
  const double radius = node.radius + 3 * position_error_;
  SignedBounds bounds = memory_.bounds[index];
  bounds.meet(memory_.nodes[index].moved(centre, sign_rule_));
  if (settle(node, bounds, radius)) return;
  if (may_settle(bounds, radius) && (has_work() || index == 0)) {
    ask_centre(node, centre, bounds);
    memory_.nodes[index] = {centre, bounds};
    if (settle(node, bounds, radius)) return;
  }
  descend(index, centre, bounds, radius);
}

// Returns whether the depth of every point of a node is known.
bool ShellQuery::settle(const Node& node, const SignedBounds& bounds, double radius) {
  if (sign_rule_ == SignRule::kByPoint) {
    // No point is near the surface, but any of them may be inside.
    if (!(bounds.gap - radius > free_) || side_rule_ != SideRule::kSolid) return false;
    find_sides(node, bounds);
    return true;
  }
  if (bounds.lower - radius > free_) return true;
  if (!(bounds.upper + radius < full_)) return false;
  add_full(node);
  return true;
}

// Returns whether a better answer about the centre could settle a node.
bool ShellQuery::may_settle(const SignedBounds& bounds, double radius) const {
  if (sign_rule_ == SignRule::kByPoint)
    return side_rule_ == SideRule::kSolid && std::max(-bounds.lower, bounds.upper) - radius > free_;
  return bounds.upper - radius > free_ || bounds.lower + radius < full_;
}

void ShellQuery::ask_centre(const Node& node, const Vec3& centre, SignedBounds& bounds) {
  const bool asks_side = sign_rule_ == SignRule::kContinuous && !bounds.knows_side();
  QueryOptions options;
  options.parts = asks_side ? kDistance | kSide : kDistance;
  options.max_error = kCentreError * node.radius;
  const double search = bounds.upper < 0 ? full_search_ : free_search_;
  options.max_distance = search + (1 + kLookAhead) * node.radius;
  const ClosestPoint answer = ask(centre, options);
  Side side = asks_side ? answer.side : Side::kUnknown;
  if (!asks_side && sign_rule_ == SignRule::kContinuous)
    side = bounds.lower > 0 ? Side::kOutside : Side::kInside;
  SignedBounds found = SignedBounds::of(answer, side, sign_rule_);
  found.meet(bounds);
  bounds = found;
}

void ShellQuery::descend(std::uint32_t index, const Vec3& centre, const SignedBounds& bounds,
                         double radius) {
  const Node& node = tree_.nodes()[index];
  memory_.bounds[index] = bounds;
  if (node.children == 0) {
    memory_.leaves.push_back({bounds.lower - radius, index});
    return;
  }
  for (std::uint32_t child = node.first_child; child < node.first_child + node.children; ++child) {
    const Vec3 to = transform_.apply(tree_.nodes()[child].centre);
    memory_.bounds[child] = bounds.moved(upper_length(to - centre), sign_rule_);
    memory_.queue.push_back(child);
  }
}

// Asks for the side of each point of a node that is far from the surface, and treats those that are
// not outside as near it.
void ShellQuery::find_sides(const Node& node, const SignedBounds& bounds) {
  const Vec3 centre = transform_.apply(node.centre);
  for (std::uint32_t point = node.first; point < node.first + node.count; ++point) {
    const Vec3 at = transform_.apply(tree_.points()[point].position);
    SignedBounds there = bounds.moved(upper_length(at - centre), sign_rule_);
    if (has_work()) {
      there.meet(ask(at, {.parts = kSide}).side);
      if (there.lower > free_) continue;
    }
    examine_point(point, at, there);
  }
}

void ShellQuery::examine_points(const Node& node, const SignedBounds& bounds) {
  const Vec3 centre = transform_.apply(node.centre);
  for (std::uint32_t point = node.first; point < node.first + node.count; ++point) {
    const Vec3 at = transform_.apply(tree_.points()[point].position);
    examine_point(point, at, bounds.moved(upper_length(at - centre), sign_rule_));
  }
}

void ShellQuery::examine_point(std::uint32_t point, const Vec3& at, SignedBounds bounds) {
  Known& known = memory_.points[point];
  bounds.meet(known.moved(at, sign_rule_));
  if (bounds.lower - position_error_ > free_) return;
  if (bounds.upper + position_error_ < full_) return add_full(point, at);
  Vec3 direction = transform_.rotate(tree_.points()[point].normal);
  bool is_proven = false;
  if (has_work()) {
    Side side = Side::kUnknown;
    const ClosestPoint answer = ask_point(at, bounds, side);
    SignedBounds found = SignedBounds::of(answer, side, sign_rule_);
    is_proven = answer.status == Status::kExact;
    // What is proven does not depend on earlier calls.
    if (!is_proven) found.meet(bounds);
    bounds = found;
    known = {at, bounds};
    if (bounds.lower - position_error_ > free_) return;
    if (bounds.upper + position_error_ < full_) return add_full(point, at);
    if (options_.force_direction == ForceDirection::kModelNormal) direction = answer.normal;
  }
  add(point, at, bounds, is_proven, direction);
}

// Asks for the distance of a point, and for its side unless it is known.
ClosestPoint ShellQuery::ask_point(const Vec3& at, const SignedBounds& bounds, Side& side) {
  const bool by_model = options_.force_direction == ForceDirection::kModelNormal;
  const bool knows_side = sign_rule_ == SignRule::kUnsigned ||
                          (sign_rule_ == SignRule::kContinuous && bounds.knows_side());
  QueryOptions options;
  options.parts = by_model ? kAllParts : knows_side ? kDistance : kDistance | kSide;
  if (options_.depth_rule == DepthRule::kTwoSided) options.normal_rule = NormalRule::kTowardQuery;
  options.max_distance =
      bounds.upper < 0 ? full_search_ : free_search_ + kLookAhead * tree_.leaf_radius();
  ClosestPoint answer = ask(at, options);
  side = (options.parts & (kSide | kNormal)) ? answer.side
         : bounds.lower > 0                  ? Side::kOutside
                                             : Side::kInside;
  const bool is_deep = answer.status == Status::kBeyondMaxDistance && side == Side::kInside;
  if (!is_deep || sign_rule_ == SignRule::kUnsigned || !has_work()) return answer;
  options.max_distance = full_search_;
  return ask(at, options);
}

void ShellQuery::add_full(const Node& node) {
  for (std::uint32_t point = node.first; point < node.first + node.count; ++point)
    add_full(point, transform_.apply(tree_.points()[point].position));
}

void ShellQuery::add_full(std::uint32_t point, const Vec3& at) {
  const double depth = options_.max_depth;
  if (depth == 0) return;
  memory_.hits.push_back(
      {point, true, at, transform_.rotate(tree_.points()[point].normal), depth, depth, depth});
}

void ShellQuery::add(std::uint32_t point, const Vec3& at, const SignedBounds& bounds,
                     bool is_proven, const Vec3& direction) {
  const auto depth_at = [&](double distance, double slack) {
    const double depth = options_.margin - distance;
    return std::clamp(depth + slack * octree::kEndRounding * std::fabs(depth), 0.0,
                      options_.max_depth);
  };
  ShellHit hit{point, is_proven, at, direction, 0, 0, 0};
  hit.depth_lower = depth_at(bounds.upper + position_error_, -1);
  hit.depth_upper = depth_at(bounds.lower - position_error_, 1);
  if (hit.depth_upper == 0) return;
  const double known = std::isfinite(bounds.best) ? bounds.best : bounds.upper;
  if (std::isfinite(known)) hit.depth = depth_at(known, 0);
  hit.depth = std::clamp(hit.depth, hit.depth_lower, hit.depth_upper);
  memory_.hits.push_back(hit);
}

}  // namespace planetree::query
