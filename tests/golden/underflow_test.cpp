// Coordinates so much smaller than the model that they vanish in the model frame.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>
#include <string>

#include "tests/golden/samples.h"
#include "tests/golden/spec_tree.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::golden {
namespace {

// Triangles whose x is 0 or the closest to it, in a model of size 10^300.
std::string fan_of_slivers(int triangle_count) {
  std::string text = "v 1e300 0 0\n";
  for (int i = 0; i < triangle_count; ++i) {
    char lines[160];
    std::snprintf(lines, sizeof lines, "v %s %de296 1e298\nv %s %de296 1e298\nf 1 %d %d\n",
                  i % 2 == 0 ? "-1e-310" : "0", i, i % 2 == 0 ? "0" : "-1e-310", i, 2 * i + 2,
                  2 * i + 3);
    text += lines;
  }
  return text;
}

TEST(Underflow, JoinsPositiveAndNegativeZero) {
  const storage::TemporaryDirectory folder;
  std::ofstream(folder / "slivers.obj") << fan_of_slivers(100);
  const SpecTree tree{SpecFile(build_bytes(folder / "slivers.obj", 4096, 1))};
  std::size_t triangles = 0;
  for (const SpecPage& page : tree.pages())
    for (const auto& [link, block] : page.blocks) {
      std::set<SpecPoint> positions;
      for (const SpecTriangle& triangle : block.triangles)
        for (const SpecPoint& corner : triangle.corners) {
          positions.insert(corner);
          EXPECT_FALSE(std::signbit(corner[0]));
        }
      EXPECT_EQ(block.vertex_count, positions.size());
      triangles += block.triangles.size();
    }
  EXPECT_EQ(triangles, 100u);
  EXPECT_EQ(tree.triangles(tree.header().root_link()).size(), 100u);
}

}  // namespace
}  // namespace planetree::golden
