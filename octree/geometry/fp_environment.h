#pragma once

#include <cfenv>
#include <cstdint>

namespace planetree::octree {

/// Puts the floating-point modes of the calling thread aside. While this object lives, results are
/// rounded to nearest, subnormal numbers are numbers and nothing traps. A thread that rounds
/// another way or flushes to zero, as audio and haptic threads do, would otherwise get other bits,
/// and one that traps would end at an inexact result. Every public call that computes holds one.
///
/// cost     reads one register where the thread's modes are the usual ones.
/// threads  of this thread alone; end it on the thread that made it.
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
  static constexpr std::uint32_t kFlags = 0x3f;      ///< exceptions that have occurred
  static constexpr std::uint32_t kDefault = 0x1f80;  ///< all exceptions masked, nothing else
  std::uint32_t before_;
#else
  std::fenv_t before_;
#endif
};

}  // namespace planetree::octree
