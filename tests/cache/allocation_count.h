#pragma once

#include <cstdint>

namespace planetree::cache {

/// Whether allocations are counted in this build. Sanitizers bring their own operator new, which
/// must not be replaced.
bool allocations_are_counted() noexcept;

/// Number of calls of any operator new in this program so far, by all threads.
std::uint64_t allocation_count() noexcept;

/// The same, by this thread alone.
std::uint64_t thread_allocation_count() noexcept;

}  // namespace planetree::cache
