#pragma once

#include <gtest/gtest.h>

#include <string>

#include "planetree/eviction_policy.h"

namespace planetree::cache {

inline constexpr EvictionPolicy kAllPolicies[] = {EvictionPolicy::kClock, EvictionPolicy::kLru,
                                                  EvictionPolicy::kSieve, EvictionPolicy::kS3Fifo,
                                                  EvictionPolicy::kTwoQ};

/// Names a parametrised test after its policy.
inline std::string policy_test_name(const testing::TestParamInfo<EvictionPolicy>& info) {
  constexpr const char* kNames[] = {"Clock", "Lru", "Sieve", "S3Fifo", "TwoQ"};
  return kNames[static_cast<int>(info.param)];
}

}  // namespace planetree::cache
