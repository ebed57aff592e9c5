#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "tools/check/file_parts.h"
#include "tools/check/issue.h"

namespace planetree::tools {

/// The issues found: the first kMaxKept in full, the others counted.
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

struct CheckReport {
  IssueList issues;
  std::uint64_t pages = 0;  ///< that could be decoded, and what they hold:
  std::uint64_t nodes = 0;
  std::uint64_t blocks = 0;
  std::uint64_t triangles = 0;
  std::uint64_t mask_cells = 0;
};

/// Certain after each page.
using CheckProgress = std::function<void(std::uint32_t pages_done)>;

/// Holds a file against every promise of the format (format-spec/ISSUES.md);
/// does not stop at the first that is broken. What follows from an issue
/// already told, such as subtrees below a page that is lost, is not told again.
///
/// full    also every triangle and vertex, and what mask and sheets say of them
/// memory  one page, the links to pages not yet come, and with `full` about
///         2 bits for each triangle and up to 256 MiB
CheckReport check_file(FileParts& parts, bool full, const CheckProgress& progress = {});

}  // namespace planetree::tools
