#include "tools/check/field_check.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "octree/field/field_page.h"
#include "octree/geometry/strict_math.h"
#include "octree/nearest/nearest.h"
#include "query/answer/model_geometry.h"
#include "query/serve/page_accessor.h"
#include "tools/check/model_reader.h"

namespace planetree::tools {
namespace {

// Compares stored points with the nearest points that a search of the tree finds.
class FieldProof {
 public:
  FieldProof(const FileParts& parts, ModelReader opened)
      : shape_(query::field_shape(parts.header()->model)), opened_(std::move(opened)) {}

  // Returns whether a stored point is near to a nearest surface point.
  bool holds(std::uint64_t number, const octree::FieldPoint& stored) {
    const octree::Point at = shape_.lower + shape_.at(number);
    const octree::Point point = shape_.lower + shape_.surface_point(stored);
    // The stored point need not be that of the triangle found: others may be as near.
    return std::fabs((at - point).norm() - distance(at)) <= shape_.uncertainty() &&
           distance(point) <= shape_.uncertainty();
  }

 private:
  double distance(const octree::Point& from) {
    query::PageAccessor accessor(opened_.reader, Wait::kForPages);
    octree::TraversalStats work;
    return octree::nearest(opened_.model->geometry().tree, from, {}, accessor.pages(), work)
        .distance;
  }

  octree::FieldShape shape_;
  ModelReader opened_;
};

class FieldCheck {
 public:
  FieldCheck(FileParts& parts, IssueList& issues) : parts_(parts), issues_(issues) {}

  void open_proof() {
    auto opened = ModelReader::open(parts_.path());
    if (opened)
      proof_.emplace(parts_, *std::move(opened));
    else
      issues_.add(Issue::from(IssueCode::kPageRead, opened.error()));
  }

  // Returns whether the page is sound.
  bool check_page(std::uint32_t page) {
    std::optional<Issue> issue = parts_.load_page(page);
    const bool is_sound = !issue;
    if (issue) issues_.add(*std::move(issue));
    if (is_sound && proof_) prove(page);
    return is_sound;
  }

 private:
  void prove(std::uint32_t page) {
    const std::size_t count = query::field_points(*parts_.header(), page);
    std::vector<octree::FieldPoint> points(count);
    std::memcpy(points.data(), parts_.frame_bytes(), count * sizeof points[0]);
    const std::uint64_t in_page = octree::points_per_field_page(parts_.header()->page_bytes);
    const std::uint64_t first = in_page * (page - parts_.first_field_page());
    for (std::size_t i = 0; i < count; ++i)
      if (!proof_->holds(first + i, points[i]))
        issues_.add({IssueCode::kField, page, Error::kNowhere,
                     fmt::format("the point stored for grid point {} is not the nearest one of the "
                                 "surface",
                                 first + i)});
  }

  FileParts& parts_;
  IssueList& issues_;
  std::optional<FieldProof> proof_;
};

}  // namespace

void check_field(FileParts& parts, bool prove, CheckReport& report, const CheckProgress& progress) {
  FieldCheck check(parts, report.issues);
  if (prove && parts.first_field_page() < parts.first_attribute_page()) check.open_proof();
  for (std::uint32_t page = parts.first_field_page(); page < parts.first_attribute_page(); ++page) {
    report.pages += check.check_page(page) ? 1 : 0;
    if (progress) progress(page + 1);
  }
}

}  // namespace planetree::tools
