#include "tools/tune/optimum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "tests/tools/tune/made_references.h"
#include "tools/cli/policy_option.h"
#include "tools/tune/policy_replay.h"
#include "tools/tune/stack_distances.h"

namespace planetree::tools {
namespace {

/// The least misses of any choice of pages to evict: tries them all.
class AllChoices {
 public:
  AllChoices(std::span<const std::uint32_t> lookups, std::size_t frames)
      : lookups_(lookups), frames_(frames) {}

  std::uint64_t misses(std::size_t at = 0, const std::set<std::uint32_t>& resident = {}) {
    if (at == lookups_.size()) return 0;
    if (resident.contains(lookups_[at])) return misses(at + 1, resident);
    const auto key = std::pair(at, resident);
    if (const auto known = known_.find(key); known != known_.end()) return known->second;
    std::uint64_t least = lookups_.size();
    auto then = resident;
    then.insert(lookups_[at]);
    if (resident.size() < frames_) {
      least = misses(at + 1, then);
    } else {
      for (const std::uint32_t victim : resident) {
        auto left = then;
        left.erase(victim);
        least = std::min(least, misses(at + 1, left));
      }
    }
    return known_[key] = least + 1;
  }

 private:
  std::span<const std::uint32_t> lookups_;
  std::size_t frames_;
  std::map<std::pair<std::size_t, std::set<std::uint32_t>>, std::uint64_t> known_;
};

TEST(Optimum, IsTheLeastOfAllChoices) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::mt19937_64 random(seed);
    References references;
    for (int i = 0; i < 40; ++i) references.add(1 + static_cast<std::uint32_t>(random() % 7));
    const std::vector<std::uint32_t> frames = {2, 3, 4, 5, 6, 7, 8, 9};
    const auto misses = optimum_misses(references, frames);
    for (std::size_t i = 0; i < frames.size(); ++i)
      ASSERT_EQ(misses[i], AllChoices(references.stored(), frames[i] - 1).misses())
          << "seed " << seed << ", frames " << frames[i];
  }
}

TEST(Optimum, IsNeverBeaten) {
  for (const References& references :
       {skewed_references(20'000, 300, 1), walked_references(20'000, 200, 2)}) {
    std::vector<std::uint32_t> frames;
    for (std::uint32_t count = 2; count <= references.footprint(); count += 1 + count / 3)
      frames.push_back(count);
    const auto optimum = optimum_misses(references, frames);
    const StackDistances lru = StackDistances::of(references);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_LE(optimum[i], lru.misses(frames[i]));
      EXPECT_GE(optimum[i], references.compulsory());
      for (const EvictionPolicy policy : kAllPolicies)
        EXPECT_LE(optimum[i], replayed_misses(references, policy, frames[i])) << name_of(policy);
    }
  }
}

}  // namespace
}  // namespace planetree::tools
