#include "tests/layering/layers.h"

#include <gtest/gtest.h>

namespace planetree::layering {
namespace {

using Lines = std::vector<std::string>;

Lines forbidden_in(const std::string& path, const std::string& text) {
  return forbidden_includes({path, text});
}

TEST(SourceText, FindsIncludesHoweverTheyAreWritten) {
  EXPECT_EQ(includes_of("#include \"cache/limbo.h\"\nint a;\n  #  include <sys/mman.h> // b\n"
                        "// #include <c>\n#pragma once\n#include MACRO\n#include <vector>"),
            (Lines{"cache/limbo.h", "sys/mman.h", "vector"}));
}

TEST(SourceText, TellsTheStandardLibraryFromTheRest) {
  EXPECT_TRUE(is_standard_header("vector"));
  EXPECT_FALSE(is_standard_header("lz4.h"));
  EXPECT_FALSE(is_standard_header("Eigen/Core"));
}

TEST(Layers, AllowWhatLiesBelow) {
  EXPECT_EQ(forbidden_in("octree/build/merge.cpp",
                         "#include \"storage/file/page_writer.h\"\n"
                         "#include \"octree/geometry/plane.h\"\n"
                         "#include <oneapi/tbb/parallel_for.h>\n"),
            Lines{});
  EXPECT_EQ(forbidden_in("storage/file/page_codec.cpp", "#include <lz4.h>\n#include <vector>\n"),
            Lines{});
}

TEST(Layers, RefuseWhatLiesAboveOrBeside) {
  EXPECT_EQ(forbidden_in("storage/a.cpp", "#include \"cache/limbo.h\"\n"),
            Lines{"storage/a.cpp may not include cache/limbo.h"});
  EXPECT_EQ(forbidden_in("cache/a.h", "#include \"storage/file/page_file.h\"\n").size(), 1u);
  EXPECT_EQ(forbidden_in("octree/a.cpp", "#include \"octree/build/merge.h\"\n").size(), 1u);
  EXPECT_EQ(forbidden_in("octree/build/a.cpp", "#include \"cache/limbo.h\"\n").size(), 1u);
  EXPECT_EQ(forbidden_in("query/a.cpp", "#include \"tools/cli/progress.h\"\n").size(), 1u);
  EXPECT_EQ(forbidden_in("storage/a.h", "#include \"planetree/types.h\"\n").size(), 1u);
}

TEST(Layers, RefuseIncludesRelativeToTheIncluder) {
  EXPECT_EQ(forbidden_in("cache/a.h", "#include \"limbo.h\"\n").size(), 1u);
  EXPECT_EQ(forbidden_in("cache/a.h", "#include \"../storage/system/mapping.h\"\n").size(), 1u);
}

TEST(Layers, KeepLibrariesToTheirSoleIncluders) {
  EXPECT_EQ(forbidden_in("storage/file/page_file.cpp", "#include <lz4.h>\n").size(), 1u);
  EXPECT_EQ(forbidden_in("storage/file/page_codec.cpp", "#include <xxhash.h>\n").size(), 1u);
  EXPECT_EQ(forbidden_in("include/planetree/a.h", "#include <Eigen/Core>\n").size(), 1u);
  EXPECT_EQ(forbidden_in("include/planetree/a.h", "#include <hwy/highway.h>\n").size(), 1u);
  EXPECT_EQ(forbidden_in("tests/octree/a_test.cpp", "#include <CGAL/AABB_tree.h>\n").size(), 1u);
  EXPECT_EQ(forbidden_in("tests/oracle/a_test.cpp", "#include <CGAL/AABB_tree.h>\n"), Lines{});
}

}  // namespace
}  // namespace planetree::layering
