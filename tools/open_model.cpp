#include "tools/open_model.h"

#include <algorithm>
#include <cinttypes>
#include <thread>

namespace planetree::tools {

Result<Model> open_model(const std::filesystem::path& path, std::uint64_t memory_bytes,
                         Console& console, unsigned batch_threads) {
  OpenOptions options;
  options.memory_budget_bytes = memory_bytes;
  options.max_probes = 1;
  if (batch_threads == 0) batch_threads = std::max(std::thread::hardware_concurrency(), 1u);
  options.batch_threads = std::min(batch_threads, OpenOptions::kMostBatchThreads);
  auto model = Model::open(path, options);
  if (model && model->stats().header_copy_damaged)
    console.warn(path.string(),
                 "one of its two headers is damaged; copy the file anew or build it again");
  return model;
}

std::optional<Error> unreadable_pages(const Stats& stats) {
  if (stats.quarantined_pages == 0) return std::nullopt;
  return make_error(ErrorCode::kDamaged, Error::kNowhere, Error::kNowhere,
                    "%" PRIu64 " of its pages cannot be read, so %" PRIu64
                    " answers are degraded; planetree verify names the pages",
                    stats.quarantined_pages, stats.degraded_answers);
}

}  // namespace planetree::tools
