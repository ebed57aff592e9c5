#pragma once

#include <cstdint>
#include <memory>

#include "cache/policy/policy_tables.h"
#include "planetree/eviction_policy.h"

namespace planetree::cache {

/// An eviction policy over lists of pages, written from its paper without regard to speed, readers
/// and frames that are held.
class PolicyOracle {
 public:
  virtual ~PolicyOracle() = default;
  /// A resident page was used.
  virtual void use(std::uint32_t page) = 0;
  /// Evicts a page and returns it. At least one page is resident.
  virtual std::uint32_t evict() = 0;
  /// A page became resident.
  virtual void install(std::uint32_t page, PageTier tier) = 0;
};

std::unique_ptr<PolicyOracle> make_policy_oracle(EvictionPolicy policy, std::uint32_t frame_count);

}  // namespace planetree::cache
