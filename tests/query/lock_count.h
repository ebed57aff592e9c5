#pragma once

#include <cstdint>

namespace planetree::query {

/// Whether locks are counted in this build. Sanitizers bring their own pthread_mutex_lock, which
/// must not be replaced.
bool locks_are_counted() noexcept;

/// Number of calls of pthread_mutex_lock by this thread so far.
std::uint64_t lock_count() noexcept;

}  // namespace planetree::query
