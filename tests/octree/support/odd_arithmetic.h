#pragma once

#include <cfenv>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace planetree {

/// What a host thread may have asked of its processor: to round another way and
/// to take subnormal numbers for zero. Until this object ends.
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
