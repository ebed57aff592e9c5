#pragma once

#include <cstdint>

namespace planetree::query {

/// Whether locks are counted here: sanitizers bring a pthread_mutex_lock of
/// their own, which must not be replaced.
bool locks_are_counted() noexcept;

/// Calls of pthread_mutex_lock by this thread so far.
std::uint64_t lock_count() noexcept;

}  // namespace planetree::query
