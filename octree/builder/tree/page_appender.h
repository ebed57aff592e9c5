#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "octree/builder/job/build_progress.h"
#include "planetree/error.h"
#include "storage/file/page_writer.h"

namespace planetree::octree {

/// A page as it goes to the file, before compression.
struct FilePage {
  std::uint64_t octcode = 0;
  std::uint32_t ordinal = 0;
  std::vector<std::byte> bytes;
  std::size_t blocks_at = 0;  ///< distance page: offset of the blocks' triangle counts
};

/// Makes pages in parallel and appends them to a file in their order.
class PageAppender {
 public:
  /// total  number of all pages that will be appended, for `progress`.
  PageAppender(storage::PageWriter& writer, BuildProgress& progress, std::uint32_t total)
      : writer_(writer), progress_(progress), total_(total) {}

  /// Appends make(i) for every i below `count`. Uses the calling thread's TBB arena.
  Result<void> append(std::uint32_t count,
                      const std::function<Result<FilePage>(std::uint32_t)>& make);

 private:
  Result<void> report();

  storage::PageWriter& writer_;
  BuildProgress& progress_;
  const std::uint32_t total_;
  std::uint32_t appended_ = 0;
};

}  // namespace planetree::octree
