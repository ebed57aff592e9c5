#pragma once

#include <hwy/targets.h>

#include <cstdint>
#include <vector>

namespace planetree::octree {

/// Results of call() on each instruction set that this processor has.
template <class Call>
auto on_each_target(const Call& call) {
  std::vector<decltype(call())> results;
  for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    hwy::SetSupportedTargetsForTest(left & -left);
    results.push_back(call());
    hwy::SetSupportedTargetsForTest(0);
  }
  return results;
}

}  // namespace planetree::octree
