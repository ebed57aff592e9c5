#include "tools/check/file_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "tools/check/attribute_check.h"
#include "tools/check/field_check.h"
#include "tools/check/geometry_check.h"
#include "tools/check/height_field_check.h"
#include "tools/check/mask_check.h"
#include "tools/check/tree_check.h"

namespace planetree::tools {
namespace {

/// Checks that the longest edge of the core is at least 1 and below 2 in the model frame. Edges of
/// a point, and those that are lost to rounding, have any length.
void check_scale(const storage::ModelRecord& model, IssueList& issues) {
  double half = 0;
  for (int axis = 0; axis < 3; ++axis)
    half = std::max(half, model.core_upper[axis] / 2 - model.core_lower[axis] / 2);
  if (half < 0x1p-1001) return;
  const double edge = std::ldexp(half, model.scale_exponent + 1);
  if (edge >= 1 && edge < 2) return;
  issues.add({IssueCode::kHeaderField, Error::kNowhere, offsetof(storage::FileHeader, model),
              "the header's scale is not that of its core; build the file again"});
}

/// Adds the issues that were found at open. Returns whether the header's fields are right, so that
/// pages can be understood.
bool add_issues(const FileParts& parts, IssueList& issues) {
  for (const Issue& issue : parts.issues()) {
    issues.add(issue);
    if (issue.code == IssueCode::kHeaderField) return false;
  }
  if (parts.header() == nullptr) return false;
  const std::uint64_t before = issues.count();
  check_scale(parts.header()->model, issues);
  return issues.count() == before;
}

}  // namespace

CheckReport check_file(FileParts& parts, bool full, const CheckProgress& progress) {
  CheckReport report;
  if (!add_issues(parts, report.issues)) return report;
  const storage::FileHeader& header = *parts.header();
  if (parts.page_count() == 0) return report;  // the file ends within its directory
  std::optional<GeometryCheck> surface, caps;
  if (full) surface.emplace(header, report.issues);
  const TreeSection of_surface = TreeSection::of_surface(parts);
  bool complete = check_tree(parts, of_surface, surface ? &*surface : nullptr, report, progress);
  if (surface) surface->finish(complete);
  if (header.model.cap_count > 0 || parts.first_cap_page() < parts.first_field_page()) {
    if (full) caps.emplace(header, report.issues, true);
    const TreeSection of_caps = TreeSection::of_caps(parts);
    complete = check_tree(parts, of_caps, caps ? &*caps : nullptr, report, progress) && complete;
    if (caps) caps->finish_caps(complete, *surface);
  }
  const auto is_proving = [&] { return full && report.issues.count() == 0; };
  if (is_proving()) surface->check_keys(parts.entries());
  if (is_proving() && caps) caps->check_keys(parts.entries());
  check_field(parts, is_proving(), report, progress);
  check_attributes(parts, is_proving(), report, progress);
  check_mask(parts, is_proving(), report, progress);
  if (is_proving()) check_height_fields(parts, report.issues);
  return report;
}

}  // namespace planetree::tools
