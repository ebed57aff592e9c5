// Rules that hold for every source file of the repository.

#include "tests/layering/cmake_layers.h"
#include "tests/layering/layers.h"
#include "tests/layering/source_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
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

TEST(SourceRules, FindsSources) {
  EXPECT_TRUE(paths().contains("include/planetree/error.h"));
  EXPECT_TRUE(paths().contains("tests/layering/source_rules_test.cpp"));
}

TEST(SourceRules, IncludesFollowTheLayers) {
  for (const SourceText& source : sources()) {
    for (const std::string& line : forbidden_includes(source)) ADD_FAILURE() << line;
  }
}

TEST(SourceRules, ReachesNoFolderThatItsRowDoesNotName) {
  std::map<std::string, SourceText> by_path;
  for (const SourceText& source : sources()) by_path.emplace(source.path, source);
  for (const SourceText& source : sources())
    for (const std::string& line : forbidden_reach(source, by_path)) ADD_FAILURE() << line;
}

TEST(SourceRules, HasNoArrowThatRunsBackUp) {
  for (const std::string& line : arrows_back_up(layers())) ADD_FAILURE() << line;
}

// A folder is a CMake target: planetree_add_layer() names the folders that it depends on.
TEST(SourceRules, StatesTheSameFoldersToCMake) {
  const std::map<std::string, CMakeLayer> targets = read_cmake_layers(kRoot);
  for (const Layer& layer : layers()) {
    const std::string folder(layer.folder);
    if (folder == "include/planetree" || folder.starts_with("examples") || folder == "python" ||
        folder.starts_with("tests"))
      continue;
    ASSERT_TRUE(targets.contains(folder)) << folder << " has no CMake target";
    for (const std::string_view include : layer.includes) {
      ASSERT_TRUE(targets.contains(std::string(include))) << include;
      EXPECT_TRUE(targets.at(folder).depends.contains(targets.at(std::string(include)).name))
          << folder << " includes " << include << ", which its DEPENDS does not name";
    }
  }
}

TEST(SourceRules, EveryFolderSaysWhatItHolds) {
  for (const Layer& layer : layers()) {
    if (layer.folder.starts_with("include")) continue;
    EXPECT_TRUE(std::filesystem::exists(kRoot + '/' + std::string(layer.folder) + "/README.md"))
        << layer.folder << " has no README.md";
  }
}

TEST(SourceRules, FoldersStaySmall) {
  constexpr int kMaxFiles = 40;
  std::map<std::string, int> counts;
  for (const SourceText& source : sources()) ++counts[source.folder()];
  for (const auto& [folder, count] : counts) EXPECT_LE(count, kMaxFiles) << folder;
}

TEST(SourceRules, SourcesIncludeTheirOwnHeaderFirst) {
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

TEST(SourceRules, HeadersHavePragmaOnce) {
  for (const SourceText& source : sources()) {
    if (!source.is_header() || source.path.ends_with("-inl.h")) continue;
    EXPECT_TRUE(source.text.find("#pragma once\n") != std::string::npos) << source.path;
  }
}

TEST(SourceRules, FilesStayShort) {
  for (const SourceText& source : sources()) {
    EXPECT_LE(std::ranges::count(source.text, '\n'), kLongestFileLines) << source.path;
  }
}

TEST(SourceRules, InstallsEveryPublicHeader) {
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
