#include "cache/reader.h"

#include <utility>

#include "cache/page_cache.h"

namespace planetree::cache {

Reader::Reader(PageCache& cache, ReaderSlot& slot, std::uint32_t index) noexcept
    : map_(cache.map_),
      reference_bits_(cache.policy_.reference_bits()),
      frames_(cache.frames_.frame(0)),
      stride_bytes_(cache.frames_.stride_bytes()),
      slot_(&slot),
      index_(index),
      cache_(&cache) {}

Reader::Reader(Reader&& other) noexcept
    : map_(other.map_),
      reference_bits_(other.reference_bits_),
      frames_(other.frames_),
      stride_bytes_(other.stride_bytes_),
      slot_(std::exchange(other.slot_, nullptr)),
      index_(other.index_),
      cache_(other.cache_) {}

Reader& Reader::operator=(Reader&& other) noexcept {
  if (this == &other) return *this;
  give_back();
  map_ = other.map_;
  reference_bits_ = other.reference_bits_;
  frames_ = other.frames_;
  stride_bytes_ = other.stride_bytes_;
  slot_ = std::exchange(other.slot_, nullptr);
  index_ = other.index_;
  cache_ = other.cache_;
  return *this;
}

Reader::~Reader() { give_back(); }

void Reader::give_back() noexcept {
  if (slot_ == nullptr) return;
  if (slot_->inside()) slot_->leave();
  std::exchange(slot_, nullptr)->release();
}

FetchResult Reader::fetch(std::uint32_t page, const FetchTerms& terms) noexcept {
  slot_->leave();
  return cache_->fetch(*slot_, page, terms);
}

bool Reader::help() noexcept {
  assert(!inside());
  return cache_->help(index_);
}

}  // namespace planetree::cache
