#include "tools/tune/policy_replay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "tests/cache/policy/policy_frames.h"
#include "tests/tools/tune/made_references.h"
#include "tools/cli/policy_option.h"

namespace planetree::tools {
namespace {

/// Replays every lookup of a trace, with a search for each page and the root among the others.
std::uint64_t plain_misses(const MadeTrace& trace, EvictionPolicy policy, std::uint32_t frames) {
  cache::PolicyFrames cache(policy, frames, 1000);
  const auto tier = [](std::uint32_t page) {
    return is_upper(page) ? cache::PageTier::kUpper : cache::PageTier::kLower;
  };
  cache.evictor().pin(cache.install(References::kRootPage, tier(References::kRootPage)));
  std::uint64_t misses = 0;
  for (std::size_t i = 0; i < trace.pages.size(); ++i) {
    const std::uint32_t page = trace.pages[i];
    if (cache.has(page)) {
      cache.use(page);
    } else {
      misses += i >= trace.opening();
      cache.read(page, tier(page));
    }
  }
  return misses;
}

TEST(PolicyReplay, MissesWhatAPlainReplayMisses) {
  for (const MadeTrace& trace : {skewed_trace(8000, 200, 1), walked_trace(8000, 60, 2)}) {
    const References references = references_of(trace);
    EXPECT_LT(references.stored().size(), trace.pages.size());
    for (const std::uint32_t frames : {2U, 3U, 5U, 9U, 17U, 33U, 90U, 300U})
      for (const EvictionPolicy policy : kAllPolicies)
        EXPECT_EQ(replayed_misses(references, policy, frames), plain_misses(trace, policy, frames))
            << name_of(policy) << ", frames " << frames;
  }
}

TEST(PolicyReplay, MissesOnlyWhatItMustWhereAllPagesFit) {
  const References references = skewed_references(5000, 100, 3);
  for (const EvictionPolicy policy : kAllPolicies) {
    EXPECT_EQ(replayed_misses(references, policy, references.footprint()), references.compulsory())
        << name_of(policy);
    EXPECT_EQ(replayed_misses(references, policy, 100'000), references.compulsory())
        << name_of(policy);
    EXPECT_GT(replayed_misses(references, policy, 20), references.compulsory()) << name_of(policy);
  }
}

TEST(PolicyReplay, TellsTheMissesOfEachQuery) {
  References references = skewed_references(3000, 60, 4);
  std::mt19937_64 random(6);
  for (int query = 0; query < 500; ++query) {
    references.begin_query();
    for (std::uint64_t lookups = random() % 5; lookups > 0; --lookups)
      references.add(1 + static_cast<std::uint32_t>(random() % 40));
  }
  for (const EvictionPolicy policy : kAllPolicies) {
    const auto misses = replayed_misses_by_query(references, policy, 20);
    ASSERT_EQ(misses.size(), 500u);
    EXPECT_LE(*std::max_element(misses.begin(), misses.end()), 4u);
    EXPECT_GT(std::accumulate(misses.begin(), misses.end(), 0u), 100u) << name_of(policy);
  }
}

}  // namespace
}  // namespace planetree::tools
