#pragma once

#include <mutex>
#include <optional>

#include "planetree/error.h"

namespace planetree::query {

/// The last error of reading a page. Any number of threads may use it; none of them is a real-time
/// thread.
class ReadError {
 public:
  void set(const Error& error) noexcept {
    const std::lock_guard lock(mutex_);
    last_ = error;
  }
  std::optional<Error> get() const noexcept {
    const std::lock_guard lock(mutex_);
    return last_;
  }

 private:
  mutable std::mutex mutex_;
  std::optional<Error> last_;
};

}  // namespace planetree::query
