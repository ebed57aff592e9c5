#include "tools/tune/references.h"

#include <gtest/gtest.h>

#include "tests/tools/tune/made_references.h"

namespace planetree::tools {
namespace {

using cache::PageTier;

TEST(References, NumberPagesByTheirFirstLookups) {
  References references;
  for (const std::uint32_t page : {9U, 4U, 9U, 7U}) references.add(page);
  EXPECT_EQ(std::vector(references.stored().begin(), references.stored().end()),
            (std::vector<std::uint32_t>{0, 1, 0, 2}));
  EXPECT_EQ(references.number_of(7), 2u);
  EXPECT_EQ(references.number_of(5), References::kNoNumber);
  EXPECT_EQ(references.number_of(500), References::kNoNumber);
  EXPECT_EQ(references.pages()[2].file_page, 7u);
  EXPECT_EQ(references.footprint(), 4u) << "the root has a frame too";
  EXPECT_EQ(references.compulsory(), 3u);
}

TEST(References, CountWhatTheyDoNotStore) {
  References references;
  for (int i = 0; i < 100; ++i) {
    references.add(3);
    references.add(References::kRootPage);
  }
  EXPECT_EQ(references.stored().size(), References::kMaxRun);
  EXPECT_EQ(references.lookups(), 200u);
  EXPECT_EQ(references.root_tier(), PageTier::kLower);
  references.set_upper(References::kRootPage);
  EXPECT_EQ(references.root_tier(), PageTier::kUpper);
}

TEST(References, KeepTheTierOfPagesThatAreLookedUpBeforeOrAfter) {
  References references;
  references.add(3);
  references.set_upper(3);
  references.set_upper(8);
  references.add(8);
  references.add(5);
  EXPECT_EQ(references.pages()[0].tier, PageTier::kUpper);
  EXPECT_EQ(references.pages()[1].tier, PageTier::kUpper);
  EXPECT_EQ(references.pages()[2].tier, PageTier::kLower);
}

TEST(References, DoNotCountWhatOpeningLooksUp) {
  References references;
  for (const std::uint32_t page : {1U, 2U, 2U}) references.add(page);
  references.end_opening();
  for (const std::uint32_t page : {2U, 3U, 1U, 4U}) references.add(page);
  EXPECT_EQ(references.opening(), 3u);
  EXPECT_EQ(references.stored().size(), 7u) << "a run ends with the opening";
  EXPECT_EQ(references.lookups(), 4u);
  EXPECT_EQ(references.compulsory(), 2u);
}

TEST(References, HaveDisjointSamplesThatShareTheirLookups) {
  const References references = skewed_references(50'000, 400, 1);
  std::size_t pages = 0, stored = 0, opening = 0;
  for (std::uint32_t group = 0; group < 4; ++group) {
    const References sample = references.sampled(4, group);
    pages += sample.pages().size();
    stored += sample.stored().size();
    opening += sample.opening();
    for (const References::Page& page : sample.pages())
      EXPECT_NE(references.number_of(page.file_page), References::kNoNumber);
  }
  EXPECT_EQ(pages, references.pages().size());
  // Runs that others interrupted are shortened once they do not.
  EXPECT_LE(stored, references.stored().size());
  EXPECT_GT(stored, references.stored().size() * 9 / 10);
  EXPECT_NEAR(static_cast<double>(opening), static_cast<double>(references.opening()), 100);
}

}  // namespace
}  // namespace planetree::tools
