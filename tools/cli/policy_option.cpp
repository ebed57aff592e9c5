#include "tools/cli/policy_option.h"

#include <algorithm>
#include <iterator>

namespace planetree::tools {

const char* name_of(EvictionPolicy policy) {
  switch (policy) {
    case EvictionPolicy::kClock:
      return "clock";
    case EvictionPolicy::kLru:
      return "lru";
    case EvictionPolicy::kSieve:
      return "sieve";
    case EvictionPolicy::kS3Fifo:
      return "s3fifo";
    case EvictionPolicy::kTwoQ:
      return "2q";
  }
  return "";
}

void add_policy(SubcommandOptions& subcommand, EvictionPolicy& policy) {
  std::vector<std::string> names;
  for (const EvictionPolicy each : kAllPolicies) names.emplace_back(name_of(each));
  const auto take = [&policy](const std::string& name) {
    policy = *std::find_if(std::begin(kAllPolicies), std::end(kAllPolicies),
                           [&name](EvictionPolicy each) { return name == name_of(each); });
  };
  SubcommandOptions::default_text(
      subcommand.word(
          "--policy", names, take,
          "How the page to evict is chosen where memory is short. Answers do not depend "
          "on it, the number of pages read does"),
      name_of(policy));
}

}  // namespace planetree::tools
