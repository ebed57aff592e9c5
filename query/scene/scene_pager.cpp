#include "query/scene/scene_pager.h"

#include <algorithm>
#include <new>
#include <utility>

namespace planetree::query {

Result<std::unique_ptr<ScenePager>> ScenePager::create(const cache::CacheLimits& limits,
                                                       const PageFiller::Limits& filler) {
  std::unique_ptr<ScenePager> pager(new (std::nothrow) ScenePager);
  if (!pager)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory for a scene; free some and try again");
  cache::CacheLimits all = limits;
  all.reserved_bytes += sizeof(ScenePager) + PageFiller::bytes(filler);
  const auto fill = [](void* context, const cache::FillRequest& request) {
    return static_cast<ScenePager*>(context)->fill(request);
  };
  auto cache = cache::PageCache::create(all, fill, pager.get());
  if (!cache) return cache.error();
  pager->cache_ = std::move(*cache);
  if (const auto claimed = pager->filler_.claim(filler); !claimed) return claimed.error();
  return pager;
}

Result<std::uint32_t> ScenePager::add(const storage::PageFile& file, std::uint32_t page_count,
                                      std::uint64_t bytes) {
  const auto first = cache_->add_file(page_count, bytes);
  if (!first) return first.error();
  try {
    const std::lock_guard lock(mutex_);
    files_.push_back({*first, &file});
  } catch (const std::bad_alloc&) {
    cache_->remove_file(*first, bytes);
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory for one more file; free some and try again");
  }
  const auto pinned = cache_->pin(*first);
  if (pinned) return *first;
  remove(*first, bytes);
  return pinned.error();
}

void ScenePager::remove(std::uint32_t first, std::uint64_t bytes) noexcept {
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(files_, [first](const Pages& pages) { return pages.first == first; });
  }
  cache_->remove_file(first, bytes);
}

Result<cache::FillResult> ScenePager::fill(const cache::FillRequest& request) noexcept {
  Pages pages{};
  {
    const std::lock_guard lock(mutex_);
    for (const Pages& each : files_)
      if (each.first <= request.page && (!pages.file || each.first > pages.first)) pages = each;
  }
  return filler_.fill(*pages.file, request.page - pages.first, request);
}

}  // namespace planetree::query
