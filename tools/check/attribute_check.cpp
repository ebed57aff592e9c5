#include "tools/check/attribute_check.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "query/answer/mesh_triangle.h"
#include "query/serve/page_accessor.h"
#include "tools/check/model_reader.h"

namespace planetree::tools {
namespace {

void follow_links(const FileParts& parts, IssueList& issues) {
  auto opened = ModelReader::open(parts.path());
  if (!opened) return issues.add(Issue::from(IssueCode::kPageRead, opened.error()));
  const query::ModelGeometry& model = opened->model->geometry();
  query::PageAccessor accessor(opened->reader, Wait::kForPages);
  std::uint64_t found = 0;
  for (std::uint64_t index = 0; index < model.attributes.index_count; ++index) {
    const auto triangle = query::find_mesh_triangle(model, accessor.pages(), index);
    if (triangle)
      ++found;
    else if (triangle.error().code != ErrorCode::kNotFound)
      issues.add(Issue::from(IssueCode::kAttributes, triangle.error()));
  }
  // No index is in two blocks, so that as many links as triangles are those of all triangles.
  if (const std::uint64_t all = parts.header()->model.triangle_count; found != all)
    issues.add({IssueCode::kAttributes, parts.first_attribute_page(), Error::kNowhere,
                fmt::format("{} of {} triangles have a link; build the file again", found, all)});
}

}  // namespace

void check_attributes(FileParts& parts, bool prove, CheckReport& report,
                      const CheckProgress& progress) {
  const std::uint32_t first = parts.first_attribute_page(), end = parts.first_mask_page();
  bool are_sound = true;
  for (std::uint32_t page = first; page < end; ++page) {
    if (std::optional<Issue> issue = parts.load_page(page)) {
      report.issues.add(*std::move(issue));
      are_sound = false;
    } else {
      ++report.pages;
    }
    if (progress) progress(page + 1);
  }
  if (prove && are_sound && first < end) follow_links(parts, report.issues);
}

}  // namespace planetree::tools
