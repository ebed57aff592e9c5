// Regions of any model, with any query. PLANETREE_TEST_EFFORT in the environment multiplies the
// number of models.

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

#include "tests/differential/parted_model.h"
#include "tests/oracle/closed_models.h"

namespace planetree::oracle {
namespace {

void check_families(std::span<const NastyFamily> families, std::uint64_t seed,
                    const std::vector<double>& sizes, Seen& seen) {
  for (const NastyFamily& family : families)
    for (int i = 0; i < static_cast<int>(6 * test_effort()); ++i) {
      Random random(seed + static_cast<std::uint64_t>(i));
      const double size = sizes[static_cast<std::size_t>(i) % sizes.size()];
      SCOPED_TRACE(std::string(family.name) + " model " + std::to_string(i));
      const Soup soup = scaled(family.make(random), size);
      const RegionBox box = random_box(random, soup, size);
      WholeAndRegion model(soup, box, size, random.one_in(2) ? 65536 : 4096);
      for (int k = 0; k < 60 && !testing::Test::HasFailure(); ++k) {
        QueryOptions options;
        if (random.one_in(4)) options.max_error = size * random.magnitude(-20, 1);
        if (random.one_in(4)) options.max_distance = size * random.magnitude(-10, 1);
        if (random.one_in(10)) options.max_work = static_cast<std::uint32_t>(random.below(12));
        model.check(some_query(random, soup, box, size), options);
      }
      seen.exact += model.seen().exact;
      seen.degraded += model.seen().degraded;
      seen.within_error += model.seen().within_error;
      seen.beyond += model.seen().beyond;
      seen.inside += model.seen().inside;
      seen.outside += model.seen().outside;
      seen.unknown += model.seen().unknown;
      if (testing::Test::HasFailure()) return;
    }
}

TEST(RandomRegions, MatchTheWholeModelForNastyModels) {
  Seen seen;
  check_families(nasty_families(), 7000, {1}, seen);
  EXPECT_GT(seen.exact, 100);
  EXPECT_GT(seen.degraded, 100);
  EXPECT_GT(seen.within_error, 30);
  EXPECT_GT(seen.beyond, 10);
}

TEST(RandomRegions, MatchTheWholeModelForNastyWatertightModels) {
  Seen seen;
  check_families(closed_families(), 8000, {1, 1, 0x1p-996, 0x1p500, 0x1p37}, seen);
  EXPECT_GT(seen.exact, 100);
  EXPECT_GT(seen.inside, 100);
  EXPECT_GT(seen.outside, 100);
  EXPECT_GT(seen.unknown, 100);
}

}  // namespace
}  // namespace planetree::oracle
