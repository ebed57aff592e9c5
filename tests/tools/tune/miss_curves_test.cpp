#include "tools/tune/miss_curves.h"

#include <gtest/gtest.h>

#include "tests/tools/tune/made_references.h"
#include "tools/cli/policy_option.h"
#include "tools/tune/policy_replay.h"
#include "tools/tune/stack_distances.h"

namespace planetree::tools {
namespace {

TEST(MissCurves, AreExactForShortTraces) {
  const References references = walked_references(20'000, 150, 1);
  const auto curves = miss_curves(references, curve_sizes(references.footprint()));
  EXPECT_EQ(curves.sampled_step, 1u);
  EXPECT_EQ(curves.error, 0);
  EXPECT_EQ(curves.frames.size(), 16u);
  EXPECT_EQ(curves.frames.front(), 4u);
  EXPECT_EQ(curves.frames.back(), references.footprint());
  const StackDistances distances = StackDistances::of(references);
  for (std::size_t i = 0; i < curves.frames.size(); ++i) {
    const std::uint32_t frames = curves.frames[i];
    EXPECT_EQ(curves.stack[i], static_cast<double>(distances.misses(frames)));
    EXPECT_EQ(curves.policies[0].misses[i],
              static_cast<double>(replayed_misses(references, EvictionPolicy::kClock, frames)));
    for (const MissCurve& policy : curves.policies)
      EXPECT_GE(policy.misses[i], curves.optimum[i]) << name_of(policy.policy) << " " << frames;
  }
  EXPECT_EQ(curves.optimum.back(), static_cast<double>(references.compulsory()));
}

TEST(MissCurves, OfASampleAreNearTheExactOnes) {
  const References references = skewed_references(400'000, 60'000, 4);
  const auto exact = miss_curves(references, curve_sizes(references.footprint()));
  CurveLimits limits;
  limits.exact_lookups = 100'000;
  limits.sampled_pages = 10'000;
  const auto sampled = miss_curves(references, curve_sizes(references.footprint()), limits);
  EXPECT_EQ(sampled.sampled_step, references.footprint() / 10'000);
  ASSERT_EQ(sampled.frames, exact.frames);
  EXPECT_EQ(sampled.stack, exact.stack);
  EXPECT_GT(sampled.first_sampled, 0u);
  EXPECT_LT(sampled.first_sampled, sampled.frames.size());
  EXPECT_GT(sampled.error, 0);
  EXPECT_LT(sampled.error, 0.01);
  const double lookups = static_cast<double>(references.lookups());
  for (std::size_t i = 0; i < exact.frames.size(); ++i) {
    if (i < sampled.first_sampled) {
      EXPECT_EQ(sampled.optimum[i], exact.optimum[i]) << "not sampled";
    }
    EXPECT_NEAR(sampled.optimum[i] / lookups, exact.optimum[i] / lookups, 0.01) << exact.frames[i];
    for (std::size_t policy = 0; policy < exact.policies.size(); ++policy)
      EXPECT_NEAR(sampled.policies[policy].misses[i] / lookups,
                  exact.policies[policy].misses[i] / lookups, 0.01)
          << name_of(exact.policies[policy].policy) << " " << exact.frames[i];
  }
}

TEST(MissCurves, OfSeveralTracesAreTheirSums) {
  const References one = walked_references(5000, 80, 1), other = walked_references(5000, 60, 2);
  const auto sizes = curve_sizes(one.footprint(), 6);
  MissCurves sum = miss_curves(one, sizes);
  const double first = sum.policies[2].misses[1], optimum = sum.optimum[3];
  const MissCurves added = miss_curves(other, sizes);
  add_curves(added, sum);
  EXPECT_EQ(sum.policies[2].misses[1], first + added.policies[2].misses[1]);
  EXPECT_EQ(sum.optimum[3], optimum + added.optimum[3]);
  EXPECT_EQ(sum.stack.back(), static_cast<double>(one.compulsory() + other.compulsory()));
  EXPECT_EQ(sum.sampled_step, 1u);
}

TEST(MissCurves, HaveDifferentSizesOfAscendingOrder) {
  EXPECT_EQ(curve_sizes(1, 16), (std::vector<std::uint32_t>{4}));
  EXPECT_EQ(curve_sizes(7, 16), (std::vector<std::uint32_t>{4, 5, 6, 7}));
  EXPECT_EQ(curve_sizes(9, 1), (std::vector<std::uint32_t>{9}));
  const auto sizes = curve_sizes(100'000, 16);
  EXPECT_EQ(sizes.size(), 16u);
  EXPECT_TRUE(std::is_sorted(sizes.begin(), sizes.end()));
}

TEST(MissCurves, HaveAKneeWhereTheyBend) {
  EXPECT_EQ(knee_of({2, 4, 8, 16, 32}, {100, 60, 12, 10, 9}), 2u);
  EXPECT_EQ(knee_of({2, 4}, {5, 5}), 0u);
}

}  // namespace
}  // namespace planetree::tools
