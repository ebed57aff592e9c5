#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "tools/check/file_parts.h"
#include "tools/check/issue.h"

namespace planetree::tools {

/// Issues of a file. The first kMaxKept are kept in full, the others are counted.
class IssueList {
 public:
  static constexpr std::size_t kMaxKept = 1000;

  void add(Issue issue) {
    ++count_;
    if (kept_.size() < kMaxKept) kept_.push_back(std::move(issue));
  }
  std::uint64_t count() const { return count_; }
  const std::vector<Issue>& kept() const { return kept_; }

 private:
  std::vector<Issue> kept_;
  std::uint64_t count_ = 0;
};

/// Issues, and counts over all pages that could be decoded.
struct CheckReport {
  IssueList issues;
  std::uint64_t pages = 0;
  std::uint64_t nodes = 0;
  std::uint64_t blocks = 0;
  std::uint64_t triangles = 0;
  std::uint64_t mask_cells = 0;
};

/// Called after each page.
using CheckProgress = std::function<void(std::uint32_t pages_done)>;

/// Checks a file against all rules of the format (format-spec/ISSUES.md) and continues after an
/// issue. What follows from a reported issue, such as subtrees below a lost page, is not reported.
///
/// full    checks also every triangle and vertex, and proves mask and height fields
/// memory  one page and the pending links to later pages; with `full` also about 2 bits for each
///         triangle, 24 bytes for each subtree, and up to 256 MiB
CheckReport check_file(FileParts& parts, bool full, const CheckProgress& progress = {});

}  // namespace planetree::tools
