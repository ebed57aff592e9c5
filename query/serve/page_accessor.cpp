#include "query/serve/page_accessor.h"

namespace planetree::query {

// Pages of asks come first, one for each that this thread wants: neither waits for all of the
// other's.
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
