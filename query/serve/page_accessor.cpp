#include "query/serve/page_accessor.h"

namespace planetree::query {

// A fetch thread (stop_ is set) first reads one page that a blocking query waits for, so that
// neither waits for all pages of the other.
const std::byte* PageAccessor::fetch(std::uint32_t number) noexcept {
  if (trace_) trace_->fetched(number);
  release_frames();
  if (stop_) {
    reader_.leave();
    reader_.help();
    reader_.enter();
  }
  const cache::FetchResult fetched = reader_.fetch(number, terms_);
  if (fetched.given_up) {
    missed_ = true;
    may_wait_ = false;
  }
  return fetched.frame;
}

}  // namespace planetree::query
