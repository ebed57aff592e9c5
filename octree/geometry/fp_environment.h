#pragma once

#include <cfenv>
#include <cstdint>

namespace planetree::octree {

/// Sets the floating-point mode of the thread while this object lives: results are rounded to
/// nearest, subnormal numbers are not flushed, and nothing traps. The destructor restores the mode
/// of the host program. Without this object, a thread that rounds otherwise or flushes to zero, as
/// audio and haptic threads do, would get other bits; and one that traps would be killed by an
/// inexact result. Every public function that computes holds one.
///
/// cost     reads one register if the thread is in the default mode
/// threads  destroy it on the thread that created it
class FpEnvironmentGuard {
 public:
#if defined(__SSE2__)
  FpEnvironmentGuard() noexcept : before_(__builtin_ia32_stmxcsr()) {
    if ((before_ & ~kFlags) != kDefault) __builtin_ia32_ldmxcsr(kDefault);
  }
  ~FpEnvironmentGuard() {
    if ((before_ & ~kFlags) != kDefault) __builtin_ia32_ldmxcsr(before_);
  }
#else
  FpEnvironmentGuard() noexcept { std::fegetenv(&before_), std::fesetenv(FE_DFL_ENV); }
  ~FpEnvironmentGuard() { std::fesetenv(&before_); }
#endif
  FpEnvironmentGuard(const FpEnvironmentGuard&) = delete;
  FpEnvironmentGuard& operator=(const FpEnvironmentGuard&) = delete;

 private:
#if defined(__SSE2__)
  static constexpr std::uint32_t kFlags = 0x3f;      ///< exception flags raised so far
  static constexpr std::uint32_t kDefault = 0x1f80;  ///< all exceptions masked, nothing else set
  std::uint32_t before_;
#else
  std::fenv_t before_;
#endif
};

}  // namespace planetree::octree
