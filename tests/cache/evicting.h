#pragma once

#include <cstdint>

#include "cache/eviction_policy.h"

namespace planetree::cache {

inline void install_all(EvictionPolicy& policy, std::uint32_t frames) {
  for (std::uint32_t frame = 0; frame < frames; ++frame) policy.install(frame);
}

/// Evicts one frame and returns it; kNoFrame if none is evictable.
inline std::uint32_t evict_one(EvictionPolicy& policy) {
  const std::uint32_t victim = policy.choose_victim();
  if (victim != kNoFrame) policy.remove(victim);
  return victim;
}

}  // namespace planetree::cache
