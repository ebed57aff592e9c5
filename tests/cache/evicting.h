#pragma once

#include <cstdint>

#include "cache/eviction_policy.h"

namespace planetree::cache {

inline void install_all(EvictionPolicy& policy, std::uint32_t frames) {
  for (std::uint32_t frame = 0; frame < frames; ++frame) policy.install(frame);
}

/// The frame that the policy gives up; kNoFrame if none.
inline std::uint32_t evict_one(EvictionPolicy& policy) {
  const std::uint32_t victim = policy.choose_victim();
  if (victim != kNoFrame) policy.remove(victim);
  return victim;
}

}  // namespace planetree::cache
