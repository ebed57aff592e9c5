#pragma once

#include <cstdint>

namespace planetree::cache {

/// Whether allocations are counted here: sanitizers bring an operator new of
/// their own, which must not be replaced.
bool allocations_are_counted() noexcept;

/// Calls of any operator new in this program so far, by all threads.
std::uint64_t allocation_count() noexcept;

}  // namespace planetree::cache
