#include "tests/layering/retired_words.h"

#include <gtest/gtest.h>

#include "tests/layering/source_text.h"

namespace planetree::layering {
namespace {

using Lines = std::vector<std::string>;

constexpr std::string_view kGlossary =
    "## Terms\n| `page` | kept |\n## Retired words\n\n| old | new |\n|---|---|\n"
    "| `Vicinity`, \"set aside\" | `CoherenceCache`, `skipped` |\n| `kMost*` | `kMax*` |\n";

TEST(RetiredWords, AreTheFirstColumnOfTheTable) {
  const auto words = retired_words(kGlossary);
  ASSERT_EQ(words.size(), 3u);
  EXPECT_EQ(words[0].text, "Vicinity");
  EXPECT_TRUE(words[1].is_phrase);
  EXPECT_EQ(words[2].text, "kMost");
  EXPECT_TRUE(words[2].is_beginning);
}

TEST(RetiredWords, AreFoundAsWholeWordsAndPhrasesAcrossLines) {
  const auto words = retired_words(kGlossary);
  EXPECT_EQ(uses_of(words, "a.h", "int Vicinity;\nint kMostPages;\n// Records set\n// aside.\n"),
            (Lines{"a.h:1: Vicinity", "a.h:3: set aside", "a.h:2: kMost"}));
  EXPECT_EQ(uses_of(words, "a.h", "int VicinityOf; bool set_aside_; int kMist;\n"), Lines{});
}

TEST(RetiredWords, OccurNowhere) {
  const std::string root = PLANETREE_SOURCE_DIR;
  const auto words = retired_words(read_text(root + "/docs/glossary.md"));
  const Lines paths = texts_to_search(root);
  ASSERT_GT(words.size(), 50u);
  ASSERT_GT(paths.size(), 500u);
  for (const std::string& path : paths) {
    if (path == "tests/layering/retired_words_test.cpp") continue;
    for (const std::string& use : uses_of(words, path, read_text(root + '/' + path)))
      ADD_FAILURE() << use;
  }
}

}  // namespace
}  // namespace planetree::layering
