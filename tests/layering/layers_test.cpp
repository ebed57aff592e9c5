#include "tests/layering/layers.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace planetree::layering {
namespace {

using Lines = std::vector<std::string>;

Lines forbidden_in(const std::string& path, const std::string& text) {
  return forbidden_includes({path, text});
}

TEST(SourceText, FindsIncludesInAnySpelling) {
  EXPECT_EQ(includes_of("#include \"cache/limbo.h\"\nint a;\n  #  include <sys/mman.h> // b\n"
                        "// #include <c>\n#pragma once\n#include MACRO\n#include <vector>"),
            (Lines{"cache/limbo.h", "sys/mman.h", "vector"}));
}

TEST(SourceText, RecognisesStandardHeaders) {
  EXPECT_TRUE(is_standard_header("vector"));
  EXPECT_FALSE(is_standard_header("lz4.h"));
  EXPECT_FALSE(is_standard_header("Eigen/Core"));
}

TEST(Layers, AllowFoldersBelow) {
  EXPECT_EQ(forbidden_in("octree/builder/merge.cpp",
                         "#include \"storage/file/page_writer.h\"\n"
                         "#include \"octree/geometry/child_bounds.h\"\n"
                         "#include \"planetree/types.h\"\n"
                         "#include <tbb/task_arena.h>\n"),
            Lines{});
  EXPECT_EQ(forbidden_in("storage/file/page_codec.cpp", "#include <lz4.h>\n#include <vector>\n"),
            Lines{});
}

TEST(Layers, RefuseFoldersAboveOrBeside) {
  EXPECT_EQ(forbidden_in("storage/file/a.cpp", "#include \"cache/limbo.h\"\n"),
            Lines{"storage/file/a.cpp may not include cache/limbo.h"});
  EXPECT_EQ(forbidden_in("cache/a.h", "#include \"storage/file/page_file.h\"\n").size(), 1u);
  EXPECT_EQ(forbidden_in("octree/page/a.h", "#include \"octree/traversal/bounds.h\"\n").size(), 1u);
  EXPECT_EQ(forbidden_in("octree/winding/a.h", "#include \"octree/mask/cap_grid.h\"\n").size(), 1u);
  EXPECT_EQ(forbidden_in("octree/builder/a.cpp", "#include \"cache/limbo.h\"\n").size(), 1u);
  EXPECT_EQ(forbidden_in("query/answer/a.h", "#include \"query/serve/pager.h\"\n").size(), 1u);
  EXPECT_EQ(forbidden_in("query/a.cpp", "#include \"tools/cli/progress.h\"\n").size(), 1u);
  EXPECT_EQ(forbidden_in("storage/file/a.h", "#include \"planetree/types.h\"\n").size(), 1u);
  EXPECT_EQ(forbidden_in("examples/a.cpp", "#include \"octree/geometry/child_bounds.h\"\n").size(),
            1u);
}

TEST(Layers, RefuseFoldersWithoutARow) {
  EXPECT_EQ(forbidden_in("octree/shapes/a.h", "#include <vector>\n").size(), 1u);
  EXPECT_EQ(forbidden_in("tests/shapes/a.h", "#include <vector>\n"), Lines{});
}

TEST(Layers, FollowIncludesToTheFoldersTheyReach) {
  const std::map<std::string, SourceText> sources = {
      {"query/model_state.h", {"query/model_state.h", "#include \"cache/reader.h\"\n"}},
      {"cache/reader.h", {"cache/reader.h", ""}}};
  const std::string include = "#include \"query/model_state.h\"\n";
  EXPECT_EQ(forbidden_reach({"tools/check/a.cpp", include}, sources), Lines{});
  EXPECT_EQ(forbidden_reach({"tools/cli/a.cpp", include}, sources),
            (Lines{"tools/cli/a.cpp reaches cache", "tools/cli/a.cpp reaches query"}));
}

TEST(Layers, RefuseRowsThatRunBackUp) {
  EXPECT_EQ(arrows_back_up({{"a", {}, {}, {}}, {"b", {"a"}, {}, {}}}), Lines{});
  EXPECT_EQ(arrows_back_up({{"a", {"b"}, {}, {}}, {"b", {"a"}, {}, {}}}),
            Lines{"a is above or beside b"});
}

TEST(Layers, RefuseIncludesRelativeToTheIncluder) {
  EXPECT_EQ(forbidden_in("cache/a.h", "#include \"limbo.h\"\n").size(), 1u);
  EXPECT_EQ(forbidden_in("cache/a.h", "#include \"../storage/system/mapping.h\"\n").size(), 1u);
}

TEST(Layers, RestrictLibrariesToTheirIncluders) {
  EXPECT_EQ(forbidden_in("storage/file/page_file.cpp", "#include <lz4.h>\n").size(), 1u);
  EXPECT_EQ(forbidden_in("storage/file/page_codec.cpp", "#include <xxhash.h>\n").size(), 1u);
  EXPECT_EQ(forbidden_in("include/planetree/a.h", "#include <Eigen/Core>\n").size(), 1u);
  EXPECT_EQ(forbidden_in("include/planetree/a.h", "#include <hwy/highway.h>\n").size(), 1u);
  EXPECT_EQ(forbidden_in("tests/octree/a_test.cpp", "#include <CGAL/AABB_tree.h>\n").size(), 1u);
  EXPECT_EQ(forbidden_in("tests/oracle/a_test.cpp", "#include <CGAL/AABB_tree.h>\n"), Lines{});
}

}  // namespace
}  // namespace planetree::layering
