#include "tools/check/geometry_check.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "octree/geometry/cell_overlap.h"
#include "octree/traversal/bounds.h"
#include "query/answer/model_geometry.h"
#include "query/file/scale.h"
#include "tools/check/moment_check.h"

namespace planetree::tools {
namespace {

using octree::Point;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Sums of another writer differ by rounding.
constexpr double kOpennessRounding = 0x1p-30;

Point point_of(const std::array<float, 3>& values) {
  return {static_cast<double>(values[0]), static_cast<double>(values[1]),
          static_cast<double>(values[2])};
}

/// Whether a box holds a point. Both are relative to the model's centre.
bool is_inside(const octree::FloatBox& box, const Point& point) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(static_cast<double>(box.lower[axis]) <= point[axis] &&
          point[axis] <= static_cast<double>(box.upper[axis])))
      return false;
  return true;
}

/// Whether a point lies between the planes of the slab and within the disc's radius, with the slack
/// that evaluation in float needs: 8 * 2^-24 times the box's diagonal
/// (octree/traversal/bounds.h). The point is relative to the model's centre.
bool is_inside(const Bounds& bounds, const Point& point) {
  const double diagonal = 32000 * static_cast<double>(bounds.box.plane_step());
  if (!std::isfinite(diagonal)) return true;  // no query reads it
  const double slack = octree::kDiscOffsetSlack / 2 * diagonal - octree::kAbsoluteBoundSlack;
  const Point normal = point_of(bounds.disc.normal);
  const Point from = point - point_of(bounds.box.centre());
  const double height = from.dot(normal);
  const Point across = from - height * normal;
  return static_cast<double>(bounds.disc.slab_lower) + slack <= height &&
         height + slack <= static_cast<double>(bounds.disc.slab_upper) &&
         across.norm() + slack <= static_cast<double>(bounds.disc.radius);
}

Point point_of(const double (&values)[3]) { return {values[0], values[1], values[2]}; }
Vec3 vec3_of(const double (&values)[3]) { return {values[0], values[1], values[2]}; }

}  // namespace

GeometryCheck::GeometryCheck(const storage::FileHeader& header, IssueList& issues, bool of_caps)
    : model_(header.model),
      issues_(issues),
      of_caps_(of_caps),
      keys_(query::Scale(model_.scale_exponent).in(vec3_of(model_.core_lower)),
            of_caps ? header.first_cap_page() : 0),
      edges_(model_),
      areas_(query::Scale(model_.scale_exponent).in(vec3_of(model_.core_lower)),
             query::Scale(model_.scale_exponent).in(vec3_of(model_.core_upper))),
      lower_(Point::Constant(kInfinity)),
      upper_(Point::Constant(-kInfinity)) {
  const query::Scale scale(model_.scale_exponent);
  const octree::Region region = query::region_of(model_);
  has_walls_ = region.has_walls();
  region_lower_ = region.clamped(scale.in(vec3_of(model_.box_lower)));
  region_upper_ = region.clamped(scale.in(vec3_of(model_.box_upper)));
}

void GeometryCheck::report(IssueCode code, std::uint32_t page, std::string message) {
  issues_.add({code, page, Error::kNowhere, std::move(message)});
}

void GeometryCheck::add(const octree::BlockView& block, std::uint32_t page, const Bounds* bounds) {
  add_ids(block, page);
  for (unsigned i = 0; i < block.header().vertex_count(); ++i) {
    lower_ = lower_.cwiseMin(block.vertex(i));
    upper_ = upper_.cwiseMax(block.vertex(i));
  }
  for (unsigned i = 0; i < block.triangle_count(); ++i)
    add_triangle(block.triangle(i), block.id(i), page);
  add_codes(block, bounds);
  if (bounds == nullptr) return;
  check_vertices(block, page, *bounds);
  if (of_caps_ && !moments_fit(*bounds, block, point_of(model_.centre)))
    report(IssueCode::kMoments, page,
           fmt::format(
               "the moments stated for the block of triangle {} are not those of its triangles",
               block.id(0)));
}

void GeometryCheck::add_codes(const octree::BlockView& block, const Bounds* bounds) {
  PageKeys::CodeRange range;
  for (unsigned i = 0; i < block.triangle_count(); ++i) range.add(keys_.code_of(block.triangle(i)));
  keys_.add(0, range);
  for (const Bounds* each = bounds; each != nullptr; each = each->above.get())
    if (each->subtree > 0) keys_.add(each->subtree, range);
}

void GeometryCheck::check_keys(std::span<const storage::PageEntry> entries) {
  keys_.for_each_page([&](std::uint32_t page, std::uint64_t octcode) {
    if (entries[page].octcode != octcode)
      report(IssueCode::kPageStructure, page,
             "the page's octcode is not the least of its subtrees; build the file again");
  });
}

void GeometryCheck::add_triangle(const octree::Triangle& triangle, std::uint64_t index,
                                 std::uint32_t page) {
  if (of_caps_) {
    edges_.add_cap(triangle);
    area_ += octree::area_of(triangle);
  } else {
    edges_.add(triangle, index);
    areas_.add(triangle);
  }
  if (!of_caps_ && has_walls_ && !octree::may_touch(triangle, region_lower_, region_upper_))
    report(IssueCode::kRegion, page, "a triangle does not touch the file's region");
}

void GeometryCheck::add_node(const octree::Node& node, std::uint32_t page, const Bounds& bounds) {
  if (of_caps_ && !moments_fit(bounds, node))
    report(IssueCode::kMoments, page, "a node's moments are not the sums of its children's");
}

void GeometryCheck::add_ids(const octree::BlockView& block, std::uint32_t page) {
  for (unsigned i = 0; i < block.triangle_count(); ++i) {
    const std::uint64_t id = block.id(i);
    min_id_ = std::min(min_id_, id);
    if (!insert(id))
      report(IssueCode::kTriangleTwice, page, fmt::format("triangle {} appears twice", id));
    if (!of_caps_ && id == model_.sample_triangle)
      sample_seen_ = sample_seen_ || block.triangle(i)[0] == point_of(model_.sample);
  }
}

void GeometryCheck::check_vertices(const octree::BlockView& block, std::uint32_t page,
                                   const Bounds& bounds) {
  bool in_box = true, in_planes = true;
  for (unsigned i = 0; i < block.header().vertex_count(); ++i) {
    const Point point = block.vertex(i) - point_of(model_.centre);
    in_box = in_box && is_inside(bounds.box, point);
    for (const Bounds* each = &bounds; each != nullptr; each = each->above.get())
      in_planes = in_planes && is_inside(*each, point);
  }
  const auto message = [&block](const char* what) {
    return fmt::format("a vertex of the block of triangle {} lies outside {}", block.id(0), what);
  };
  if (!in_box)
    report(IssueCode::kVertexOutsideBox, page, message("the box that its parent states"));
  if (!in_planes)
    report(IssueCode::kVertexOutsidePlanes, page,
           message("the slab or radius that a node above it states"));
}

bool GeometryCheck::insert(std::uint64_t id) {
  std::uint64_t& word = seen_[id / 512][id / 64 % 8];
  const std::uint64_t bit = std::uint64_t{1} << id % 64;
  const bool is_new = (word & bit) == 0;
  word |= bit;
  return is_new;
}

// Whether the header's box is that of the vertices along an axis, or with walls encloses them.
bool GeometryCheck::is_box(double lower, double upper, int axis) const {
  if (has_walls_) return lower <= lower_[axis] && upper_[axis] <= upper;
  return lower == lower_[axis] && upper == upper_[axis];
}

// Checks that the root's box is the least one of floats that encloses all vertices.
void GeometryCheck::check_root() {
  if (!root_) return;
  const auto wide = [](float value) { return static_cast<double>(value); };
  constexpr float kFar = std::numeric_limits<float>::infinity();
  const Point lower = lower_ - point_of(model_.centre), upper = upper_ - point_of(model_.centre);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<Eigen::Index>(axis);
    const float least = root_->lower[axis], greatest = root_->upper[axis];
    if (wide(least) <= lower[at] && lower[at] < wide(std::nextafter(least, kFar)) &&
        wide(std::nextafter(greatest, -kFar)) < upper[at] && upper[at] <= wide(greatest))
      continue;
    return issues_.add({IssueCode::kRootBox, Error::kNowhere, Error::kNowhere,
                        "the root's box is not the least one that encloses all vertices; build "
                        "the file again"});
  }
}

void GeometryCheck::finish(bool complete) {
  if (!complete) return;
  check_root();
  const query::Scale scale(model_.scale_exponent);
  const auto whole_file = [this](IssueCode code, std::string message) {
    issues_.add({code, Error::kNowhere, Error::kNowhere, std::move(message)});
  };
  for (int axis = 0; axis < 3; ++axis)
    if (!is_box(scale.in(model_.box_lower[axis]), scale.in(model_.box_upper[axis]), axis))
      whole_file(IssueCode::kModelBox,
                 fmt::format("the header's box is not that of the vertices along {}", "xyz"[axis]));
  // With walls faces are missing, so that edges cannot be checked.
  if (auto finding = has_walls_ ? std::nullopt : edges_.finding())
    whole_file(IssueCode::kUnbalancedEdges, *std::move(finding));
  const double openness = model_.unbalanced_edge_count > 0 ? areas_.openness() : 0;
  if (!has_walls_ && !(std::fabs(openness - model_.openness) <= kOpennessRounding))
    whole_file(IssueCode::kOpenness, fmt::format("the header's openness is {:.17g}, not {:.17g}",
                                                 model_.openness, openness));
  if (!sample_seen_)
    whole_file(IssueCode::kSample,
               fmt::format("the header's sample point is not corner 0 of triangle {}",
                           model_.sample_triangle));
  else if (min_id_ != model_.sample_triangle)
    whole_file(
        IssueCode::kSample,
        fmt::format("the header's sample triangle is {}, but the least index of a triangle is {}",
                    model_.sample_triangle, min_id_));
}

void GeometryCheck::finish_caps(bool complete, const GeometryCheck& surface) {
  if (!complete) return;
  check_root();
  const auto wrong = [this](std::string message) {
    issues_.add({IssueCode::kCaps, Error::kNowhere, Error::kNowhere, std::move(message)});
  };
  const query::Scale scale(model_.scale_exponent);
  for (int axis = 0; axis < 3; ++axis)
    if (!(scale.in(model_.box_lower[axis]) <= lower_[axis] &&
          upper_[axis] <= scale.in(model_.box_upper[axis])))
      wrong(fmt::format("a cap lies outside of the header's box along {}", "xyz"[axis]));
  // With walls faces are missing, so that edges cannot be checked.
  if (!has_walls_ && !surface.edges_.are_closed_by(edges_))
    wrong("the surface and its caps are not watertight together");
  // Sums in another order differ by rounding.
  if (!(std::fabs(area_ - model_.cap_area) <= 1e-9 * area_))
    wrong(fmt::format("the area of the caps is {:.6g}, but the header states {:.6g}", area_,
                      model_.cap_area));
}

}  // namespace planetree::tools
