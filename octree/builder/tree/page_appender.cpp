#include "octree/builder/tree/page_appender.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "octree/builder/job/parallel.h"
#include "storage/file/page_codec.h"

namespace planetree::octree {
namespace {

// Pages that are made together before they are written in order.
constexpr std::uint32_t kBatchPages = 256;

struct Encoded {
  std::uint64_t octcode = 0;
  std::uint32_t ordinal = 0;
  std::uint32_t raw_bytes = 0;
  std::optional<storage::StoredPage> stored;
};

}  // namespace

Result<void> PageAppender::append(std::uint32_t count,
                                  const std::function<Result<FilePage>(std::uint32_t)>& make) {
  std::vector<Encoded> batch(std::min(kBatchPages, count));
  if (const auto told = report(); !told) return told;
  for (std::uint32_t first = 0; first < count; first += kBatchPages) {
    const std::uint32_t some = std::min(kBatchPages, count - first);
    const auto encoded = for_each_in_parallel(some, [&](std::size_t i) -> Result<void> {
      const auto raw = make(first + static_cast<std::uint32_t>(i));
      if (!raw) return raw.error();
      batch[i] = {raw->octcode, raw->ordinal, static_cast<std::uint32_t>(raw->bytes.size()),
                  storage::compress_page(raw->bytes)};
      return {};
    });
    if (!encoded) return encoded;
    for (std::uint32_t i = 0; i < some; ++i) {
      const Encoded& page = batch[i];
      const auto appended = writer_.append(page.octcode, page.raw_bytes, *page.stored);
      if (!appended) return appended;
    }
    appended_ += some;
    if (const auto told = report(); !told) return told;
  }
  return {};
}

Result<void> PageAppender::report() {
  return progress_.progress(BuildPhase::kWriting, appended_, total_);
}

}  // namespace planetree::octree
