#pragma once

#include <cstdint>

namespace planetree::query {

/// Traps the system calls of the calling thread. From this call to the end of the thread every
/// system call is counted and refused (ENOSYS), except those that end a thread.
///
/// return  false where the system does not support this: nothing is trapped then
bool set_call_trap() noexcept;

/// Number of system calls trapped so far, of all threads.
std::uint64_t trapped_calls() noexcept;

}  // namespace planetree::query
