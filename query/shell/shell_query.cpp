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

bool is_number(double value) { return value >= 0 && std::isfinite(value); }

std::uint64_t limit_of(const ShellOptions& options) {
  if (options.max_work != QueryOptions::kNoLimit) return options.max_work;
  return options.wait == Wait::kNever ? ShellOptions::kRealTimeWork
                                      : std::numeric_limits<std::uint64_t>::max();
}

}  // namespace

bool is_valid(const ShellOptions& options) {
  return is_number(options.stiffness) && is_number(options.margin) && options.max_depth >= 0 &&
         octree::RigidTransform::is_in_range(options.reference) &&
         options.depth_rule <= DepthRule::kTwoSided &&
         options.force_direction <= ForceDirection::kModelNormal &&
         options.side_rule <= SideRule::kSurface && options.wait <= Wait::kNever;
}

ShellQuery::ShellQuery(ShellSource& source, ShellMemory& memory, const ToolPlace& place,
                       const ShellOptions& options)
    : source_(source),
      memory_(memory),
      tree_(memory.tree),
      transform_(place.transform),
      options_(options),
      side_rule_(side_rule_of(options, source.info())),
      sign_rule_(sign_rule_of(options, side_rule_, source.info())),
      is_limited_(limit_of(options) != std::numeric_limits<std::uint64_t>::max()),
      max_work_(limit_of(options)),
      position_error_(transform_.position_error(tree_.reach()) + place.position_error) {
  const double diagonal = upper_length(source.info().box_upper - source.info().box_lower);
  const double deepest = options.max_depth - options.margin;
  free_ = options.margin + octree::kShellSlack * (options.margin + diagonal);
  full_ = -deepest - octree::kShellSlack * (std::fabs(deepest) + diagonal);
  // A point as deep as max_depth still needs the model's normal.
  if (options.force_direction == ForceDirection::kModelNormal) full_ = -kInfinity;
  // What lies beyond is free, or full, by more than rounding.
  const double beyond = 4 * position_error_ + octree::kShellSlack * (options.margin + diagonal);
  free_search_ = free_ + beyond;
  full_search_ = std::max(free_search_, beyond - full_);
  memory.begin(sign_rule_, side_rule_);
}

void ShellQuery::run() {
  memory_.bounds[0] = {};
  memory_.queue.push_back(0);
  for (std::size_t i = 0; i < memory_.queue.size(); ++i) examine(memory_.queue[i]);
  // Where the work does not suffice for all, those points come first whose depth may have changed
  // most: points near contact of which nothing is known, then those that were not queried for long.
  // Neighbours follow each other, so that queries begin near the last one.
  if (is_limited_)
    std::ranges::sort(memory_.candidates, [](const Candidate& a, const Candidate& b) {
      return a.urgency != b.urgency ? a.urgency > b.urgency : a.point < b.point;
    });
  for (const Candidate& candidate : memory_.candidates) examine_point(candidate);
}

// Runs a query within the work that is left. No query gets most of it, unless it is little.
template <class Query>
auto ShellQuery::limited(QueryOptions options, const Query& query) {
  const std::uint64_t left = max_work_ - std::min(work_, max_work_);
  const std::uint64_t share = std::max<std::uint64_t>(QueryOptions::kRealTimeWork, max_work_ / 4);
  options.wait = options_.wait;
  options.side_rule = side_rule_;
  if (is_limited_) options.max_work = static_cast<std::uint32_t>(std::min(left, share));
  const std::uint64_t before = source_.work_spent();
  const auto answer = query(options);
  const std::uint64_t spent = std::max<std::uint64_t>(1, source_.work_spent() - before);
  work_ += is_limited_ ? std::min(spent, left) : spent;
  ++queries_;
  return answer;
}

ClosestPoint ShellQuery::ask(const Vec3& at, const QueryOptions& options) {
  return limited(options,
                 [&](const QueryOptions& limits) { return source_.closest_point(at, limits); });
}

Side ShellQuery::ask_side(const Vec3& at) {
  return limited({}, [&](const QueryOptions& limits) { return source_.contains(at, limits).side; });
}

void ShellQuery::examine(std::uint32_t index) {
  const Node& node = tree_.nodes()[index];
  const Vec3 centre = transform_.apply(node.centre);
  // The true points are within radius + error of the computed centre, and the computed points
  // within twice the error. Their answers err once more.
  const double radius = node.radius + 3 * position_error_;
  SignedBounds bounds = memory_.bounds[index];
  bounds.meet(memory_.nodes[index].moved(centre, sign_rule_));
  if (settle(node, centre, bounds, radius)) return;
  if (may_settle(bounds, radius) && (has_work() || index == 0)) {
    ask_centre(node, centre, bounds);
    memory_.nodes[index] = {centre, bounds};
    if (settle(node, centre, bounds, radius)) return;
  }
  descend(index, centre, bounds);
}

// Returns whether nothing more about a node can be told by spheres.
bool ShellQuery::settle(const Node& node, const Vec3& centre, const SignedBounds& bounds,
                        double radius) {
  if (sign_rule_ == SignRule::kByPoint) {
    // No point is near the surface, but any of them may be inside.
    if (!(bounds.gap - radius > free_)) return false;
    add_candidates(node, centre, bounds);
    return true;
  }
  if (bounds.lower - radius > free_) return true;
  if (!(bounds.upper + radius < full_)) return false;
  for (std::uint32_t point = node.first; point < node.first + node.count; ++point)
    add_full(point, transform_.apply(tree_.points()[point].position));
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

void ShellQuery::descend(std::uint32_t index, const Vec3& centre, const SignedBounds& bounds) {
  const Node& node = tree_.nodes()[index];
  if (node.children == 0) return add_candidates(node, centre, bounds);
  for (std::uint32_t child = node.first_child; child < node.first_child + node.children; ++child) {
    const Vec3 to = transform_.apply(tree_.nodes()[child].centre);
    memory_.bounds[child] = bounds.moved(upper_length(to - centre), sign_rule_);
    memory_.queue.push_back(child);
  }
}

// Adds the points of a node whose depths do not follow from what is known.
void ShellQuery::add_candidates(const Node& node, const Vec3& centre, const SignedBounds& bounds) {
  for (std::uint32_t point = node.first; point < node.first + node.count; ++point) {
    const Vec3 at = transform_.apply(tree_.points()[point].position);
    SignedBounds there = bounds.moved(upper_length(at - centre), sign_rule_);
    there.meet(memory_.points[point].moved(at, sign_rule_));
    if (settle(point, at, there)) continue;
    const double unknown = depth_at(there.lower, 0) - depth_at(there.upper, 0);
    const int urgency = unknown > 0 ? std::ilogb(unknown) : std::numeric_limits<int>::min();
    memory_.candidates.push_back({point, urgency, at, there});
  }
}

// Returns whether a point is free, or as deep as max_depth, by more than rounding.
bool ShellQuery::settle(std::uint32_t point, const Vec3& at, const SignedBounds& bounds) {
  if (bounds.lower - position_error_ > free_) return true;
  if (!(bounds.upper + position_error_ < full_)) return false;
  add_full(point, at);
  return true;
}

void ShellQuery::examine_point(const Candidate& candidate) {
  const Vec3& at = candidate.at;
  SignedBounds bounds = candidate.bounds;
  Vec3 direction = transform_.rotate(tree_.points()[candidate.point].normal);
  bool is_proven = false;
  // Far from a surface that is not watertight, most points need a side alone.
  if (has_work() && sign_rule_ == SignRule::kByPoint && bounds.gap - position_error_ > free_ &&
      side_rule_ == SideRule::kSolid) {
    bounds.meet(ask_side(at));
    if (settle(candidate.point, at, bounds)) return;
  }
  if (has_work()) {
    Side side = Side::kUnknown;
    const ClosestPoint answer = ask_point(at, bounds, side);
    SignedBounds found = SignedBounds::of(answer, side, sign_rule_);
    is_proven = answer.status == Status::kExact;
    // What is proven does not depend on earlier calls.
    if (!is_proven) found.meet(bounds);
    bounds = found;
    memory_.points[candidate.point] = {at, bounds};
    if (settle(candidate.point, at, bounds)) return;
    if (options_.force_direction == ForceDirection::kModelNormal) direction = answer.normal;
  }
  add(candidate.point, at, bounds, is_proven, direction);
}

// Asks for the distance of a point, and for its side unless it is known.
ClosestPoint ShellQuery::ask_point(const Vec3& at, const SignedBounds& bounds, Side& side) {
  const bool by_model = options_.force_direction == ForceDirection::kModelNormal;
  const bool knows_side = sign_rule_ == SignRule::kUnsigned ||
                          (sign_rule_ == SignRule::kContinuous && bounds.knows_side());
  QueryOptions options;
  options.parts = by_model ? kAllParts : knows_side ? kDistance : kDistance | kSide;
  if (options_.depth_rule == DepthRule::kTwoSided) options.normal_rule = NormalRule::kTowardQuery;
  // The side of a sheet is that of the nearest feature, however far that is.
  const bool is_sheet = sign_rule_ == SignRule::kByPoint && side_rule_ == SideRule::kSurface;
  options.max_distance = is_sheet           ? kInfinity
                         : bounds.upper < 0 ? full_search_
                                            : free_search_ + kLookAhead * tree_.leaf_radius();
  ClosestPoint answer = ask(at, options);
  side = (options.parts & (kSide | kNormal)) ? answer.side
         : bounds.lower > 0                  ? Side::kOutside
                                             : Side::kInside;
  const bool is_deep = answer.status == Status::kBeyondMaxDistance && side == Side::kInside;
  if (!is_deep || sign_rule_ == SignRule::kUnsigned || !has_work()) return answer;
  options.max_distance = full_search_;
  return ask(at, options);
}

void ShellQuery::add_full(std::uint32_t point, const Vec3& at) {
  const double depth = options_.max_depth;
  if (depth == 0) return;
  memory_.hits.push_back(
      {point, true, at, transform_.rotate(tree_.points()[point].normal), depth, depth, depth});
}

void ShellQuery::add(std::uint32_t point, const Vec3& at, const SignedBounds& bounds,
                     bool is_proven, const Vec3& direction) {
  ShellHit hit{point, is_proven, at, direction, 0, 0, 0};
  hit.depth_lower = depth_at(bounds.upper + position_error_, -octree::kEndRounding);
  hit.depth_upper = depth_at(bounds.lower - position_error_, octree::kEndRounding);
  if (hit.depth_upper == 0) return;
  const double known = std::isfinite(bounds.best) ? bounds.best : bounds.upper;
  hit.depth = std::clamp(depth_at(known, 0), hit.depth_lower, hit.depth_upper);
  memory_.hits.push_back(hit);
}

// Depth at a signed distance, which may be infinite. Slack is a share of the depth.
double ShellQuery::depth_at(double distance, double slack) const {
  const double depth = options_.margin - distance;
  return std::clamp(slack == 0 ? depth : depth + slack * std::fabs(depth), 0.0, options_.max_depth);
}

}  // namespace planetree::query
