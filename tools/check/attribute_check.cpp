#include "tools/check/attribute_check.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "query/answer/mesh_triangle.h"
#include "query/serve/page_accessor.h"
#include "tools/check/model_reader.h"

namespace planetree::tools {
namespace {

class AttributeCheck {
 public:
  AttributeCheck(FileParts& parts, IssueList& issues) : parts_(parts), issues_(issues) {}

  // Returns whether the page is sound.
  bool check_page(std::uint32_t page) {
    std::optional<Issue> issue = parts_.load_page(page);
    if (!issue) return true;
    issues_.add(*std::move(issue));
    return false;
  }

  void follow_links() {
    auto opened = ModelReader::open(parts_.path());
    if (!opened) return issues_.add(Issue::from(IssueCode::kPageRead, opened.error()));
    const query::ModelGeometry& model = opened->model->geometry();
    query::PageAccessor accessor(opened->reader, Wait::kForPages);
    std::uint64_t found = 0;
    for (std::uint64_t index = 0; index < model.attributes.index_count; ++index) {
      const auto triangle = query::find_mesh_triangle(model, accessor.pages(), index);
      if (triangle)
        ++found;
      else if (triangle.error().code != ErrorCode::kNotFound)
        issues_.add(Issue::from(IssueCode::kAttributes, triangle.error()));
    }
    // No index is in two blocks, so that as many links as triangles are those of all triangles.
    if (const std::uint64_t all = parts_.header()->model.triangle_count; found != all)
      issues_.add(
          {IssueCode::kAttributes, parts_.first_attribute_page(), Error::kNowhere,
           fmt::format("{} of {} triangles have a link; build the file again", found, all)});
  }

 private:
  FileParts& parts_;
  IssueList& issues_;
};

}  // namespace

void check_attributes(FileParts& parts, bool prove, CheckReport& report,
                      const CheckProgress& progress) {
  AttributeCheck check(parts, report.issues);
  const std::uint32_t first = parts.first_attribute_page(), end = parts.first_mask_page();
  bool are_sound = true;
  for (std::uint32_t page = first; page < end; ++page) {
    const bool is_sound = check.check_page(page);
    report.pages += is_sound ? 1 : 0;
    are_sound = are_sound && is_sound;
    if (progress) progress(page + 1);
  }
  if (prove && are_sound && first < end) check.follow_links();
}

}  // namespace planetree::tools
