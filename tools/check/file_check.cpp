#include "tools/check/file_check.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>

#include "tools/check/attribute_check.h"
#include "tools/check/field_check.h"
#include "tools/check/geometry_check.h"
#include "tools/check/height_field_check.h"
#include "tools/check/mask_check.h"
#include "tools/check/tree_check.h"

namespace planetree::tools {
namespace {

/// Checks the fields of the header's model record that need no page.
void check_model(const storage::ModelRecord& model, IssueList& issues) {
  const auto wrong = [&issues](const char* message) {
    issues.add(
        {IssueCode::kHeaderField, Error::kNowhere, offsetof(storage::FileHeader, model), message});
  };
  if (model.triangle_count == 0) wrong("the header states that there is no triangle");
  if (model.skipped_count > ~std::uint64_t{0} - model.usable_triangles())
    return wrong("the header's counts of triangles overflow");
  const std::uint64_t indices = model.usable_triangles() + model.skipped_count;
  const bool names_one = model.first_skipped != storage::kNoTriangle;
  if (names_one != (model.skipped_count > 0) || (names_one && model.first_skipped >= indices))
    wrong("the index of the first skipped triangle does not fit the number of skipped ones");
  if (model.sample_triangle >= indices) wrong("the sample triangle's index is out of range");
  const auto listed =
      std::min<std::uint64_t>(model.unbalanced_edge_count, std::size(model.unbalanced_edge));
  for (std::size_t i = 0; i < listed; ++i)
    if (model.unbalanced_edge[i].triangle >= indices)
      wrong("the index of a triangle with an unbalanced edge is out of range");
}

}  // namespace

CheckReport check_file(FileParts& parts, bool full, const CheckProgress& progress) {
  CheckReport report;
  for (const Issue& issue : parts.issues()) report.issues.add(issue);
  if (parts.header() == nullptr) return report;
  const storage::FileHeader& header = *parts.header();
  check_model(header.model, report.issues);
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
  check_field(parts, is_proving(), report, progress);
  check_attributes(parts, is_proving(), report, progress);
  check_mask(parts, is_proving(), report, progress);
  if (is_proving()) check_height_fields(parts, report.issues);
  return report;
}

}  // namespace planetree::tools
