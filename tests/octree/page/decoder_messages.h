#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <initializer_list>
#include <iterator>
#include <regex>
#include <set>
#include <string>

namespace planetree::octree {

/// Expects that every error message in these sources of octree/page is in `reached`, and that
/// there are at least as many.
///
/// names  of the sources, without folder and ending
inline void expect_every_message(const std::set<std::string>& reached,
                                 std::initializer_list<const char*> names) {
  const std::regex sentence("(return|[:?=]) \"([^\"]+)\";");
  std::size_t written = 0;
  for (const char* name : names) {
    std::ifstream file(std::string(PLANETREE_SOURCE_DIR "/octree/page/") + name + ".cpp");
    ASSERT_TRUE(file) << name;
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    for (std::sregex_iterator match(text.begin(), text.end(), sentence), end; match != end;
         ++match) {
      ++written;
      EXPECT_TRUE(reached.contains((*match)[2])) << (*match)[2];
    }
  }
  EXPECT_GE(written, reached.size());
}

}  // namespace planetree::octree
