#pragma once

#include <cfenv>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace planetree {

/// Sets the floating-point mode of this thread to another rounding, and on x86 to flushing
/// subnormal numbers to zero, as a host program may. The destructor restores the mode.
class OddArithmetic {
 public:
  explicit OddArithmetic(int rounding) {
    std::fegetenv(&before_);
    std::fesetround(rounding);
#if defined(__SSE2__)
    _mm_setcsr(_mm_getcsr() | 0x8040);  // flush to zero, denormals are zero
#endif
  }
  ~OddArithmetic() { std::fesetenv(&before_); }
  OddArithmetic(const OddArithmetic&) = delete;
  OddArithmetic& operator=(const OddArithmetic&) = delete;

 private:
  std::fenv_t before_;
};

}  // namespace planetree
