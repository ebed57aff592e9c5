#pragma once

#include <limits>

/// Included by every file whose arithmetic reaches an answer or a .ptree file.
///
/// Error bounds are proven from the rounding of each single IEEE operation, and the same query must
/// get the same bits everywhere. A compiler that may reorder sums, assume finite values or keep
/// extra digits silently breaks both, so that such a build fails here. Contraction to fused
/// multiply-add leaves no macro to test; the build system turns it off.

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(__NO_SIGNED_ZEROS__) || __FINITE_MATH_ONLY__
#error "planetree needs strict IEEE arithmetic: compile it without -ffast-math and its parts"
#endif

#if __FLT_EVAL_METHOD__ != 0
#error "planetree needs each operation rounded to its own type: compile for SSE2, not for the x87"
#endif

static_assert(std::numeric_limits<double>::is_iec559 && std::numeric_limits<float>::is_iec559);
