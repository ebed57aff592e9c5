#pragma once

#include <cstdio>
#include <cstdlib>

namespace planetree {

/// Aborts with the line of the caller unless `truth`, so that libFuzzer keeps the input.
inline void expect(bool truth, const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
  if (truth) return;
  std::fprintf(stderr, "%s:%d: expectation violated\n", file, line);
  std::abort();
}

}  // namespace planetree
