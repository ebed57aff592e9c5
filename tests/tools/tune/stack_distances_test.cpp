#include "tools/tune/stack_distances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/tools/tune/made_references.h"

namespace planetree::tools {
namespace {

/// Misses of LRU in a list of pages, the last used first.
std::uint64_t listed_misses(const References& references, std::uint32_t frames) {
  std::vector<std::uint32_t> list;
  std::uint64_t misses = 0;
  for (std::size_t i = 0; i < references.stored().size(); ++i) {
    const std::uint32_t page = references.stored()[i];
    const auto found = std::find(list.begin(), list.end(), page);
    if (found != list.end()) {
      list.erase(found);
    } else {
      misses += i >= references.opening();
      if (list.size() == frames - 1) list.pop_back();
    }
    list.insert(list.begin(), page);
  }
  return misses;
}

TEST(StackDistances, AreThoseOfAListOfPages) {
  for (const References& references :
       {skewed_references(6000, 90, 1), walked_references(6000, 60, 2), References()}) {
    const StackDistances distances = StackDistances::of(references);
    for (std::uint32_t frames = 2; frames <= references.footprint() + 2; ++frames)
      ASSERT_EQ(distances.misses(frames), listed_misses(references, frames)) << frames;
  }
}

TEST(StackDistances, OfALargeCacheAreCompulsory) {
  const References references = skewed_references(5000, 80, 3);
  const StackDistances distances = StackDistances::of(references);
  EXPECT_EQ(distances.misses(references.footprint()), references.compulsory());
  EXPECT_EQ(distances.misses(1000), references.compulsory());
  EXPECT_GT(distances.misses(references.footprint() - 1), references.compulsory());
}

}  // namespace
}  // namespace planetree::tools
