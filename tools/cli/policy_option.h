#pragma once

#include "planetree/eviction_policy.h"
#include "tools/cli/subcommand_options.h"

namespace planetree::tools {

inline constexpr EvictionPolicy kAllPolicies[] = {EvictionPolicy::kClock, EvictionPolicy::kLru,
                                                  EvictionPolicy::kSieve, EvictionPolicy::kS3Fifo,
                                                  EvictionPolicy::kTwoQ};

/// The policy's word in options and reports.
const char* name_of(EvictionPolicy policy);

/// Declares the option --policy, which sets `policy`.
void add_policy(SubcommandOptions& subcommand, EvictionPolicy& policy);

}  // namespace planetree::tools
