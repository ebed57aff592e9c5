#include "octree/builder/mask/mask_sectors.h"

#include <algorithm>
#include <map>
#include <utility>

#include "octree/builder/sort/morton_order.h"
#include "octree/builder/surface/edge_crossings.h"
#include "octree/geometry/cell_overlap.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

/// A cell is not divided if this many steps leave nearly all centres in one cell: large triangles
/// with centres so near would touch all of the cells.
constexpr unsigned kFutileSteps = 4;
/// Nearly all: this share of them.
constexpr double kTogether = 0.875;

}  // namespace

Result<void> MaskSectors::divide(const TriangleRuns& runs, const TriangleRuns* caps,
                                 bool has_strays, std::uint64_t max_triangles) {
  auto end = has_strays ? runs.cut(kStrayCode) : Result<TriangleRuns::Cut>(runs.end());
  if (!end) return end.error();
  Centres centres;
  centres.add({&runs, runs.begin(), *std::move(end)});
  if (caps) centres.add({caps, caps->begin(), caps->end()});
  return divide(0, centres, max_triangles);
}

Result<void> MaskSectors::divide(std::size_t at, const Centres& centres,
                                 std::uint64_t max_triangles) {
  const GridCell cell = sectors_[at].cell;
  if (centres.size <= max_triangles || cell.level == kLevels || !grid_.has_part_of(cell)) return {};
  const auto separated = separates(cell, centres);
  if (!separated) return separated.error();
  if (!*separated) return {};
  const auto octants = octants_of(cell, centres);
  if (!octants) return octants.error();
  const std::size_t first = sectors_.size();
  sectors_[at].first_octant = static_cast<std::uint32_t>(first);
  for (unsigned octant = 0; octant < 8; ++octant) sectors_.push_back({cell.child(octant)});
  for (unsigned octant = 0; octant < 8; ++octant)
    if (const auto divided = divide(first + octant, (*octants)[octant], max_triangles); !divided)
      return divided;
  return {};
}

// Follows the octants with most centres.
Result<bool> MaskSectors::separates(GridCell cell, const Centres& centres) const {
  const auto few = static_cast<std::uint64_t>(kTogether * static_cast<double>(centres.size));
  Centres most = centres;
  for (unsigned step = 0; step < kFutileSteps && cell.level < kLevels; ++step) {
    auto octants = octants_of(cell, most);
    if (!octants) return octants.error();
    unsigned greatest = 0;
    for (unsigned octant = 0; octant < 8; ++octant) {
      // At the rim of the region, all centres may be in one octant however far apart they are.
      if (!grid_.has_part_of(cell.child(octant))) return true;
      if ((*octants)[octant].size > (*octants)[greatest].size) greatest = octant;
    }
    most = std::move((*octants)[greatest]);
    if (most.size <= few) return true;
    cell = cell.child(greatest);
  }
  return false;
}

Result<std::array<MaskSectors::Centres, 8>> MaskSectors::octants_of(const GridCell& cell,
                                                                    const Centres& centres) {
  std::array<Centres, 8> octants;
  for (const Stretch& stretch : centres.stretches) {
    TriangleRuns::Cut from = stretch.from;
    for (unsigned octant = 0; octant < 8; ++octant) {
      auto to = octant < 7 ? stretch.runs->cut(cell.child(octant + 1).first_code())
                           : Result<TriangleRuns::Cut>(stretch.to);
      if (!to) return to.error();
      octants[octant].add({stretch.runs, std::move(from), *to});
      from = *std::move(to);
    }
  }
  return octants;
}

std::size_t MaskSectors::sector_of_code(std::uint64_t code) const {
  std::size_t at = 0;
  while (sectors_[at].divided()) {
    const unsigned shift = 3 * (kLevels - sectors_[at].cell.level - 1);
    at = sectors_[at].first_octant + (code >> shift & 7);
  }
  return at;
}

/// Collects what one part of the model adds to the sectors.
class MaskSectors::Visit {
 public:
  explicit Visit(const MaskSectors& sectors) : sectors_(sectors), visitors_(sectors.float64_) {}

  void add(const storage::SpillKey& key, const Triangle& triangle) {
    // A stray has no sector of its own: it visits those that it touches.
    own_ = is_stray(key.first) ? kNone : sectors_.sector_of_code(key.first);
    const BoxedTriangle boxed(triangle);
    if (own_ != kNone && is_inside_own(boxed)) {
      rise_of(own_);
      return;
    }
    if (touched_.empty() || triangle != listed_) {
      listed_ = triangle;
      touched_.clear();
      list_touched(0, boxed);
    }
    for (const Touched& touched : touched_) {
      if (touched.as_visitor) visitors_.add({touched.sector, key.second}, triangle);
      auto& rise = rise_of(touched.sector);
      for (unsigned which = 1; which < 8; ++which) rise[which] += touched.rise[which];
    }
  }

  // Everything but the visitors.
  Part part() const {
    Part part;
    for (const auto& [at, rise] : rises_) part.rises.push_back({at, rise});
    return part;
  }
  std::vector<std::byte> take_visitors() {
    visitors_.sort();
    return visitors_.take_records();
  }

 private:
  // A sector that a triangle touches.
  struct Touched {
    std::uint32_t sector = 0;
    bool as_visitor = false;
    std::array<std::int64_t, 8> rise{};
  };

  void list_touched(std::size_t at, const BoxedTriangle& triangle) {
    const Region& sector = sectors_.sectors_[at];
    if (sector.divided()) {
      const unsigned near = octants_of_box(triangle, sectors_.grid_.middle(sector.cell));
      for (unsigned octant = 0; octant < 8; ++octant)
        if ((near >> octant & 1) != 0) list_touched(sector.first_octant + octant, triangle);
      return;
    }
    const Point lower = sectors_.grid_.lower(sector.cell),
                upper = sectors_.grid_.upper(sector.cell);
    const bool in_root = at == 0 && own_ == 0;
    if (!in_root && !may_touch(triangle.corners, lower, upper)) return;
    Touched touched{static_cast<std::uint32_t>(at),
                    at != own_ && sectors_.grid_.has_part_of(sector.cell)};
    if (may_cross_edges(triangle, lower, upper) && !has_equal_corners(triangle.corners))
      touched.rise = rise_along_edges(triangle, lower, upper);
    touched_.push_back(touched);
  }

  // Whether the triangle touches no other sector, and no edge of its own sector.
  bool is_inside_own(const BoxedTriangle& triangle) const {
    const GridCell& cell = sectors_.sectors_[own_].cell;
    return (triangle.least.array() > sectors_.grid_.lower(cell).array()).all() &&
           (triangle.greatest.array() < sectors_.grid_.upper(cell).array()).all();
  }

  // Triangles in order mostly touch the same sector as the one before.
  std::array<std::int64_t, 8>& rise_of(std::size_t at) {
    if (at != last_ || !last_rise_) last_rise_ = &rises_[static_cast<std::uint32_t>(at)];
    last_ = at;
    return *last_rise_;
  }

  // An edge lies in sides across two axes.
  static bool may_cross_edges(const BoxedTriangle& triangle, const Point& lower,
                              const Point& upper) {
    return (triangle.least.array() <= lower.array() || triangle.greatest.array() >= upper.array())
               .count() >= 2;
  }

  static std::array<std::int64_t, 8> rise_along_edges(const BoxedTriangle& triangle,
                                                      const Point& lower, const Point& upper);

  static constexpr std::size_t kNone = ~std::size_t{0};

  const MaskSectors& sectors_;
  std::size_t own_ = 0;  // kNone of a stray
  // Of the last triangle that was not inside its own sector. Copies follow each other mostly.
  Triangle listed_;
  std::vector<Touched> touched_;
  std::map<std::uint32_t, std::array<std::int64_t, 8>> rises_;  // by sector
  std::size_t last_ = 0;                                        // sector that last_rise_ is of
  std::array<std::int64_t, 8>* last_rise_ = nullptr;
  Triangles visitors_;
};

// Sums the crossings along a cell's edges: each corner is reached from the corner before it on
// the way from the least corner.
std::array<std::int64_t, 8> MaskSectors::Visit::rise_along_edges(const BoxedTriangle& triangle,
                                                                 const Point& lower,
                                                                 const Point& upper) {
  std::array<std::int64_t, 8> steps{};
  std::array<Point, 8> corners{lower};
  for (unsigned which = 1; which < 8; ++which) {
    const unsigned before = which & (which - 1);
    const unsigned axis = axis_of_edge(which, before);
    corners[which] = corners[before];
    corners[which][axis] = upper[axis];
    const DownwardSegment edge({corners[which], corners[before]}, axis);
    steps[which] = steps[before] + edge.crossing(triangle);
  }
  return steps;
}

void MaskSectors::sum_up(const Part& part) {
  const std::lock_guard lock(mutex_);
  for (const Rise& rise : part.rises) {
    Region& sector = sectors_[rise.sector];
    sector.touched = grid_.has_part_of(sector.cell);
    for (unsigned which = 0; which < 8; ++which) sector.rise[which] += rise.corners[which];
  }
}

Result<MaskSectors::Part> MaskSectors::add(const Triangles& triangles) {
  Visit visit(*this);
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    visit.add(triangles.key(i), triangles.corners(i));
  const auto visitors = visitors_.add(visit.take_visitors());
  if (!visitors) return visitors.error();
  Part part = visit.part();
  part.visitors = *visitors;
  sum_up(part);
  return part;
}

bool MaskSectors::add_extent(const Part& part) {
  for (const Rise& rise : part.rises)
    if (rise.sector >= sectors_.size() || sectors_[rise.sector].divided()) return false;
  visitors_.add_extent(part.visitors);
  sum_up(part);
  return true;
}

Result<Triangles> MaskSectors::read(std::size_t at, const TriangleRuns& runs) const {
  const GridCell& cell = sectors_[at].cell;
  const auto from = runs.cut(cell.first_code());
  if (!from) return from.error();
  // A cell has as many codes as there are finest cells in it.
  const auto to = runs.cut(cell.first_code() + (std::uint64_t{1} << 3 * (kLevels - cell.level)));
  if (!to) return to.error();
  const auto own = runs.read(*from, *to);
  if (!own) return own.error();
  const auto first = visitors_.cut({at, 0}), last = visitors_.cut({at + 1, 0});
  if (!first) return first.error();
  if (!last) return last.error();
  auto records = visitors_.read(*first, *last);
  if (!records) return records.error();
  Triangles visitors(*std::move(records), float64_);
  for (std::uint32_t i = 0; i < visitors.size(); ++i) {
    const Triangle triangle = visitors.corners(i);
    visitors.set(i, {morton_code_of(triangle, lower_), visitors.index(i)}, triangle);
  }
  visitors.sort();
  return joined(*own, visitors, at);
}

// Merges the triangles by key. Of a sector's own triangles, takes those that touch it.
Triangles MaskSectors::joined(const Triangles& own, const Triangles& visitors,
                              std::size_t sector) const {
  const GridCell& cell = sectors_[sector].cell;
  const Point lower = grid_.lower(cell), upper = grid_.upper(cell);
  Triangles all(float64_);
  all.reserve(std::size_t{own.size()} + visitors.size());
  std::uint32_t next = 0;
  const auto add_visitors_before = [&](const storage::SpillKey& key) {
    for (; next < visitors.size() && visitors.key(next) < key; ++next)
      all.add(visitors.key(next), visitors.corners(next));
  };
  for (std::uint32_t i = 0; i < own.size(); ++i) {
    const Triangle triangle = own.corners(i);
    if (sector != 0 && !may_touch(triangle, lower, upper)) continue;
    add_visitors_before(own.key(i));
    all.add(own.key(i), triangle);
  }
  constexpr std::uint64_t kLast = ~std::uint64_t{0};
  add_visitors_before({kLast, kLast});
  return all;
}

}  // namespace planetree::octree
