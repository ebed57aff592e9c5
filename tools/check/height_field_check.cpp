#include "tools/check/height_field_check.h"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "octree/builder/mask/height_field_finder.h"
#include "octree/geometry/strict_math.h"
#include "query/answer/model_geometry.h"
#include "query/serve/page_accessor.h"
#include "tools/check/model_reader.h"

namespace planetree::tools {
namespace {

class HeightFieldCheck {
 public:
  HeightFieldCheck(FileParts& parts, IssueList& issues) : parts_(parts), issues_(issues) {}

  void run() {
    for (std::uint32_t page = 0; page < parts_.first_cap_page(); ++page) {
      std::optional<Issue> issue = parts_.load_page(page);
      if (issue) return issues_.add(*std::move(issue));
      const FrameView frame = parts_.frame();
      frame.for_each_block([&](std::uint32_t index, const octree::BlockView& block) {
        if (block.header().is_height_field()) check(page, index, block);
      });
      if (unreadable_) return;
    }
  }

 private:
  void check(std::uint32_t page, std::uint32_t index, const octree::BlockView& block) {
    if (!parts_.header()->model.has_side_layer())
      return report(page, index, "marked as a height field, but the file has no side layer");
    if (query::region_of(parts_.header()->model).has_walls())
      return report(page, index,
                    "marked as a height field, but the file is of a region with walls");
    if (!is_proven(block) && !unreadable_)
      report(page, index, "marked as a height field, which cannot be proven");
  }

  bool is_proven(const octree::BlockView& block) {
    if (!open()) return false;
    query::PageAccessor accessor(proof_->reader, Wait::kForPages);
    const octree::HeightFieldFinder finder(proof_->model->geometry().tree,
                                           proof_->model->geometry().mask);
    octree::TraversalStats work;
    return finder.is_height_field(block, accessor.pages(), work);
  }

  bool open() {
    if (proof_ || unreadable_) return !unreadable_;
    auto opened = ModelReader::open(parts_.path());
    if (opened) {
      proof_.emplace(*std::move(opened));
    } else {
      unreadable_ = true;
      issues_.add(Issue::from(IssueCode::kPageRead, opened.error()));
    }
    return !unreadable_;
  }

  void report(std::uint32_t page, std::uint32_t index, const char* what) {
    issues_.add({IssueCode::kBlockHeightField, page, Error::kNowhere,
                 fmt::format("block {} is {}", index, what)});
  }

  FileParts& parts_;
  IssueList& issues_;
  std::optional<ModelReader> proof_;
  bool unreadable_ = false;
};

}  // namespace

void check_height_fields(FileParts& parts, IssueList& issues) {
  HeightFieldCheck(parts, issues).run();
}

}  // namespace planetree::tools
