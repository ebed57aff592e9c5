#pragma once

#include <cstdint>

namespace planetree::query {

/// Catches what the calling thread asks of the system: from set_call_trap() to the end of the
/// thread every call is counted and refused (ENOSYS), but those with which threads end.
///
/// return  false where the system does not let itself be watched: nothing is trapped then.
bool set_call_trap() noexcept;

/// System calls of all threads that were trapped so far.
std::uint64_t trapped_calls() noexcept;

}  // namespace planetree::query
