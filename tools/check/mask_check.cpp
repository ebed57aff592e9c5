#include "tools/check/mask_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "tools/check/mask_proof.h"
#include "tools/check/mask_walk.h"

namespace planetree::tools {
namespace {

void compare(const char* what, std::uint64_t stated, std::uint64_t found, IssueList& issues) {
  if (stated != found)
    issues.add(
        {IssueCode::kCount, Error::kNowhere, Error::kNowhere,
         fmt::format("the header states {} {}, but the pages hold {}", stated, what, found)});
}

std::unique_ptr<MaskProof> open_proof(const FileParts& parts, IssueList& issues) {
  auto proof = MaskProof::open(parts.path(), issues);
  if (proof) return *std::move(proof);
  issues.add(Issue::from(IssueCode::kPageRead, proof.error()));
  return nullptr;
}

}  // namespace

void check_mask(FileParts& parts, bool prove, CheckReport& report, const CheckProgress& progress) {
  const storage::ModelRecord& model = parts.header()->model;
  std::unique_ptr<MaskProof> proof;
  const bool has_winding = model.has_region() && model.has_side_layer();
  if (prove && (model.mask_page_count > 0 || has_winding)) proof = open_proof(parts, report.issues);
  if (proof && has_winding && !proof->check_region()) proof.reset();
  unsigned levels = 0;
  MaskWalk walk(
      parts,
      [&](const GreyCell& grey) {
        ++report.mask_cells;
        levels = std::max(levels, grey.cell.level);
        if (proof) proof->check_cell(grey);
      },
      [&](Issue issue) { report.issues.add(std::move(issue)); });
  bool complete = true;
  for (std::uint32_t page = parts.first_mask_page(); page < parts.page_count(); ++page) {
    std::optional<Issue> issue = parts.load_page(page);
    complete = complete && !issue;
    if (issue) {
      report.issues.add(*std::move(issue));
      walk.skip_page(page);
    } else {
      ++report.pages;
      walk.add(page);
    }
    if (proof) proof->end_page();
    if (progress) progress(page + 1);
  }
  if (!complete) return;
  compare("grey cells", model.mask_cell_count, report.mask_cells, report.issues);
  compare("levels of the mask", model.mask_levels, levels, report.issues);
}

}  // namespace planetree::tools
