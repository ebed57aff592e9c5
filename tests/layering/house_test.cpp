// Rules that hold for every source file of the repository.

#include "tests/layering/layers.h"
#include "tests/layering/source_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace planetree::layering {
namespace {

const std::string kRoot = PLANETREE_SOURCE_DIR;

// Keeps files from growing unnoticed. Nearly all are far shorter. A file this long usually has two
// subjects.
constexpr std::ptrdiff_t kLongestFileLines = 350;

const std::vector<SourceText>& sources() {
  static const std::vector<SourceText> all = read_sources(kRoot);
  return all;
}

std::set<std::string> paths() {
  std::set<std::string> all;
  for (const SourceText& source : sources()) all.insert(source.path);
  return all;
}

TEST(House, HasSourcesToRead) {
  EXPECT_TRUE(paths().contains("include/planetree/error.h"));
  EXPECT_TRUE(paths().contains("tests/layering/house_test.cpp"));
}

TEST(House, IncludesOnlyWhatItsLayersAllow) {
  for (const SourceText& source : sources()) {
    for (const std::string& line : forbidden_includes(source)) ADD_FAILURE() << line;
  }
}

TEST(House, SourcesIncludeTheirOwnHeaderFirst) {
  const std::set<std::string> all = paths();
  for (const SourceText& source : sources()) {
    if (source.is_header()) continue;
    const std::string header = source.path.substr(0, source.path.size() - 3) + "h";
    std::vector<std::string> includes = includes_of(source.text);
    // Highway requires this line at the top of a file that it compiles for each instruction set.
    std::erase(includes, "hwy/foreach_target.h");
    if (!all.contains(header)) continue;
    EXPECT_TRUE(!includes.empty() && includes.front() == header) << source.path;
  }
}

TEST(House, HeadersSayPragmaOnce) {
  for (const SourceText& source : sources()) {
    if (!source.is_header() || source.path.ends_with("-inl.h")) continue;
    EXPECT_TRUE(source.text.find("#pragma once\n") != std::string::npos) << source.path;
  }
}

TEST(House, FilesStayShort) {
  for (const SourceText& source : sources()) {
    EXPECT_LE(std::ranges::count(source.text, '\n'), kLongestFileLines) << source.path;
  }
}

TEST(House, InstallsEveryPublicHeader) {
  std::ifstream stream(kRoot + "/cmake/library.cmake");
  const std::set<std::string> words{std::istream_iterator<std::string>(stream), {}};
  for (const SourceText& source : sources()) {
    if (source.folder() != "include/planetree/") continue;
    std::string name = source.path.substr(source.folder().size());
    EXPECT_TRUE(words.contains(name) || words.contains(name + ')')) << source.path;
  }
}

}  // namespace
}  // namespace planetree::layering
