#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "planetree/error.h"
#include "storage/file/directory_check.h"
#include "storage/file/directory_shape.h"
#include "storage/file/file_layout.h"
#include "storage/system/byte_source.h"
#include "tools/check/issue.h"

namespace planetree::tools {

/// Reads a directory that may be damaged in any part. Where a block is damaged, it takes its
/// entries as they are, and the pages behind it from where the blocks above say that they are.
class DirectorySurvey {
 public:
  DirectorySurvey(const storage::ByteSource& file, const storage::FileHeader& header)
      : file_(file), header_(header), shape_(header.page_count) {}

  /// Reads all blocks, which must lie within the file.
  ///
  /// errors  those of ByteSource::read_at()
  Result<void> run();

  /// Where the pages are, unchecked.
  std::vector<storage::PageEntry> entries;
  std::vector<Issue> issues;

 private:
  Result<void> visit(const storage::DirectoryPlace& place, bool is_certain);
  void add_pages(const storage::DirectoryPlace& place, std::span<const std::byte> block,
                 bool is_certain);

  const storage::ByteSource& file_;
  const storage::FileHeader& header_;
  const storage::DirectoryShape shape_;
  std::uint64_t end_ = 0;  // of the page added last, from page 0 on
};

}  // namespace planetree::tools
