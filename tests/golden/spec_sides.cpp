#include "tests/golden/spec_sides.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <utility>

#include "tests/golden/spec_signs.h"
#include "tests/golden/spec_vector.h"

namespace planetree::golden {
namespace {

constexpr double kFourPi = 4 * std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double share_of(const SpecPoint& a, const SpecPoint& b, const SpecPoint& c, const SpecPoint& p) {
  return winding_number({{0, {a, b, c}, {}}}, p);
}

}  // namespace

SpecShare far(const SpecTree& caps, const SpecChild& child, const SpecPoint& p) {
  const SpecPoint middle = {child.disc.middle[0], child.disc.middle[1], child.disc.middle[2]};
  const SpecPoint q = p - caps.header().centre, v = middle - q;
  const double slack =
      0x1p-50 * (1 + std::max({std::fabs(q[0]), std::fabs(q[1]), std::fabs(q[2])}));
  SpecPoint gap{}, edges{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double lower = child.box.lower[axis], upper = child.box.upper[axis];
    gap[axis] = std::max({0.0, lower - q[axis], q[axis] - upper});
    edges[axis] = upper - lower;
  }
  const double rho = length(gap) - slack, way = length(v), s = length(edges) / 2 / way;
  if (!(rho > 0)) return {0, kInfinity};
  double t = 3 / std::pow(rho, 4);
  if (s < 1) t = std::min(t, (3 - 2 * s) / ((1 - s) * (1 - s)) / std::pow(way, 4));
  const SpecMoments& m = child.moments;
  const SpecPoint turned = {dot(m.first[0], v), dot(m.first[1], v), dot(m.first[2], v)};
  const double value = dot(m.vector, v) / std::pow(way, 3) - 3 * dot(v, turned) / std::pow(way, 5);
  const double error = 0x1p-15 * m.area / (way * way) +
                       5.25 * std::sqrt(m.area * m.second) / 127 / std::pow(way, 3) + m.second * t +
                       2 * slack * m.area / std::pow(rho, 3);
  return {value / kFourPi, error / kFourPi};
}

SpecSides::SpecSides(const SpecFile& file) : header_(file.header()), tree_(file), mask_(file) {
  all_.all = tree_.triangles(tree_.root_link());
  all_.surface_count = all_.all.size();
  if (!header_.open()) return;
  const std::vector<SpecTriangle> caps =
      caps_.emplace_back(file, SpecTree::Of::kCaps).triangles(header_.cap_root_link());
  all_.all.insert(all_.all.end(), caps.begin(), caps.end());
}

SpecSide SpecSides::side(const SpecPoint& p) const {
  if (!is_in(p, header_.wall_lower, header_.wall_upper)) return SpecSide::kUnknown;
  Closed k = closed(p);
  if (k.is_on_surface) return SpecSide::kOnSurface;
  if (!header_.open()) return k.number == 0 ? SpecSide::kOutside : SpecSide::kInside;
  if (k.is_sign) {
    const auto [v, e] = share(p, 0);
    if (std::fabs(v) + e < 0.5) return SpecSide::kInside;
    k = count(p, known_point(), all_);
  }
  const auto [v, e] = share(p, static_cast<double>(k.number));
  if (std::fabs(v) - e > 0.5) return SpecSide::kInside;
  return std::fabs(v) + e < 0.5 ? SpecSide::kOutside : SpecSide::kUnknown;
}

SpecSides::Closed SpecSides::closed(const SpecPoint& p) const {
  SpecPoint lower{}, upper{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lower[axis] = std::ldexp(header_.box_lower[axis], header_.scale_exponent);
    upper[axis] = std::ldexp(header_.box_upper[axis], header_.scale_exponent);
  }
  if (!is_in(p, lower, upper)) return {0};
  SpecCell cell;
  if (mask_.pages().empty() || !is_in(p, mask_.corner(cell, 0), mask_.corner(cell, 7)))
    return count(p, known_point(), all_);
  const SpecMaskRecord* record = &mask_.root();
  while (record->is_node()) {
    const unsigned o = octant_of(p, cell);
    if ((record->grey >> o & 1) == 0) {
      const bool black = (record->black >> o & 1) != 0, inverted = (record->inverted >> o & 1) != 0;
      return {black ? 1 : inverted ? -1 : 0, black || inverted};
    }
    cell = cell.octant(o);
    record = &mask_.octant(*record, o);
  }
  return closed_in_leaf(p, cell, *record);
}

SpecSides::Closed SpecSides::closed_in_leaf(const SpecPoint& p, const SpecCell& cell,
                                            const SpecMaskRecord& record) const {
  if (record.kind == 4) {
    bool is_on_plane = false;
    for (const auto& [a, b, c] : record.planes) {
      const double at = dot(cross(b - a, c - a), p - a);
      if (at > 0) return {record.beyond};
      is_on_plane = is_on_plane || at == 0;
    }
    return {record.behind, false, is_on_plane};
  }
  if (record.kind == 5 && cell.level < 19) {
    const SpecPoint u = mask_.in_cell(cell, p);
    if (!header_.has_walls() && record.slab.is_above(u)) return {record.corners[record.slab.top()]};
    if (!header_.has_walls() && record.slab.is_below(u))
      return {record.corners[7 - record.slab.top()]};
    const unsigned o = octant_of(p, cell);
    return count(p, {mask_.corner(cell, o), record.corners[o]}, of_blocks(record.blocks, o));
  }
  if (record.corners[0] == -128) return count(p, known_point(), all_);
  return count(p, nearest_corner(p, cell, record), all_);
}

SpecSides::Closed SpecSides::count(const SpecPoint& p, const KnownPoint& known,
                                   const Triangles& triangles) const {
  Closed k{known.number};
  for (std::size_t i = 0; i < triangles.all.size(); ++i) {
    const SpecCorners& corners = triangles.all[i].corners;
    k.is_on_surface = k.is_on_surface || (i < triangles.surface_count && is_on(p, corners));
    k.number += crossing(p, known.point, corners);
  }
  return k;
}

SpecSides::KnownPoint SpecSides::known_point() const {
  SpecPoint point{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    point[axis] = std::ldexp(header_.box_lower[axis], header_.scale_exponent) - 1;
  if (!header_.has_walls()) return {point, 0};
  return {mask_.corner({}, 0), header_.region_winding};
}

SpecSides::KnownPoint SpecSides::nearest_corner(const SpecPoint& p, const SpecCell& cell,
                                                const SpecMaskRecord& record) const {
  KnownPoint nearest{};
  double least = kInfinity;
  for (unsigned i = 0; i < 8; ++i) {
    const SpecPoint corner = mask_.corner(cell, i);
    if (length(corner - p) < least) nearest = {corner, record.corners[i]};
    least = std::min(least, length(corner - p));
  }
  return nearest;
}

// Corner 0 of octant 7 is on the sides that octants share. These are not clamped here.
unsigned SpecSides::octant_of(const SpecPoint& p, const SpecCell& cell) const {
  const SpecPoint u = mask_.in_cell(cell.octant(7), p);
  unsigned octant = 0;
  for (unsigned axis = 0; axis < 3; ++axis) octant |= unsigned{u[axis] >= 0} << axis;
  return octant;
}

bool SpecSides::is_in(const SpecPoint& p, const SpecPoint& lower, const SpecPoint& upper) const {
  bool inside = true;
  for (std::size_t axis = 0; axis < 3; ++axis)
    inside = inside && lower[axis] <= p[axis] && p[axis] <= upper[axis];
  return inside;
}

SpecSides::Triangles SpecSides::of_blocks(std::span<const SpecListedBlock> blocks,
                                          unsigned octant) const {
  Triangles found;
  std::vector<SpecTriangle> caps;
  for (const SpecListedBlock& listed : blocks) {
    if ((listed.octants >> octant & 1) == 0) continue;
    const bool of_caps = page_of_link(listed.link) >= header_.c();
    const SpecBlock& block = (of_caps ? caps_.at(0) : tree_).block(listed.link);
    std::vector<SpecTriangle>& into = of_caps ? caps : found.all;
    into.insert(into.end(), block.triangles.begin(), block.triangles.end());
  }
  found.surface_count = found.all.size();
  found.all.insert(found.all.end(), caps.begin(), caps.end());
  return found;
}

// share() of "Share of the caps", with what f64 rounds.
SpecShare SpecSides::share(const SpecPoint& p, double k) const {
  struct Open {
    double error, value;
    SpecLink link;
    bool operator<(const Open& other) const { return error < other.error; }
  };
  double w = k, e = 0;
  std::size_t unknown = 1;
  bool on_cap = false;
  std::priority_queue<Open> heap;
  heap.push({kInfinity, 0, header_.cap_root_link()});
  while (!heap.empty() && !(unknown == 0 && (std::fabs(w) - e > 0.5 || std::fabs(w) + e < 0.5))) {
    const Open open = heap.top();
    heap.pop();
    if (open.error == kInfinity) {
      --unknown;
    } else {
      w += open.value;
      e -= open.error;
    }
    if (SpecTree::is_block(open.link)) {
      for (const SpecTriangle& cap : caps_.at(0).block(open.link).triangles)
        if (!is_on(p, cap.corners))
          w -= winding_number({cap}, p);
        else if (!std::exchange(on_cap, true))
          w -= star(p);
      continue;
    }
    for (const SpecChild& child : caps_.at(0).node(open.link).children) {
      const auto [value, error] = far(caps_.at(0), child, p);
      if (error == kInfinity) {
        ++unknown;
      } else {
        w -= value;
        e += error;
      }
      heap.push({error, value, child.link});
    }
  }
  return {w, std::max(0.0, e) + 1e-12};
}

double SpecSides::star(const SpecPoint& p) const {
  // In no plane that a test has caps in.
  const SpecPoint b = {p[0] + 0.71, p[1] + 0.43, p[2] + 0.37};
  double sum = 0;
  for (std::size_t i = all_.surface_count; i < all_.all.size(); ++i) {
    const SpecCorners& t = all_.all[i].corners;
    if (!is_on(p, t)) continue;
    const int at = side_of_plane(p, t);
    bool inside = at != 0 && at == side_of_plane(b, t);
    for (std::size_t edge = 0; edge < 3; ++edge) {
      const SpecPoint &u = t[edge], &v = t[(edge + 1) % 3], &o = t[(edge + 2) % 3];
      if (u == v) continue;
      if (side_of_plane(p, {u, v, b}) != side_of_plane(o, {u, v, b})) inside = false;
      if (!is_on_edge(p, u, v)) sum += share_of(u, v, b, p);
    }
    if (inside) sum -= at;
  }
  return sum;
}

}  // namespace planetree::golden
