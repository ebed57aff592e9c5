// Checks the coarse field that the specification states against every triangle.

#include "tests/golden/spec_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "octree/field/coarse_field.h"
#include "query/file/field_loading.h"
#include "query/file/page_decoding.h"
#include "tests/golden/samples.h"
#include "tests/golden/spec_tree.h"
#include "tests/golden/spec_vector.h"

namespace planetree::golden {
namespace {

class SpecFieldTest : public testing::TestWithParam<Sample> {
 protected:
  SpecFile file_{read_file(GetParam().ptree_path())};
};

TEST_P(SpecFieldTest, StoresTheNearestPointOfEachGridPoint) {
  const SpecField field(file_);
  const SpecTree tree(file_);
  EXPECT_EQ(field.size() > 0, file_.header().triangle_count >= 1024);
  for (std::uint64_t i = 0; i < field.size(); ++i) {
    const double nearest = tree.nearest(field.grid_point(i)).distance;
    // The stored point is near to a nearest point, so that it is near to the surface.
    const double most = 0.875 * file_.header().field_quantum;
    EXPECT_NEAR(length(field.grid_point(i) - field.stored_point(i)), nearest, most);
    EXPECT_LE(tree.nearest(field.stored_point(i)).distance, most);
  }
}

TEST_P(SpecFieldTest, BoundsHoldTheDistance) {
  const SpecField field(file_);
  if (field.size() == 0) GTEST_SKIP() << "the sample is too small for a field";
  const SpecTree tree(file_);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-0.5, 1.5);
  for (int i = 0; i < 2000; ++i) {
    SpecPoint point{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      point[axis] = file_.header().field_lower[axis] + share(random) * file_.header().field_step *
                                                           (file_.header().field_size[axis] - 1);
    const SpecBounds bounds = field.bounds(point);
    const double distance = tree.nearest(point).distance;
    EXPECT_LE(bounds.lower, distance);
    EXPECT_GE(bounds.upper, distance);
  }
}

TEST_P(SpecFieldTest, LibraryComputesTheSameBounds) {
  const SpecField field(file_);
  auto file = storage::PageFile::open(GetParam().ptree_path());
  ASSERT_TRUE(file) << file.error().text;
  const octree::FieldShape shape = query::field_shape(file->header().model);
  std::vector<std::byte> memory(shape.bytes());
  const auto loaded = query::load_field(*file, 1, memory);
  ASSERT_TRUE(loaded) << loaded.error().text;
  octree::CoarseField ours;
  ours.fill(shape, loaded->points, false);
  ASSERT_EQ(ours.is_empty(), field.size() == 0);
  if (ours.is_empty()) return;
  std::mt19937 random(2);
  std::uniform_real_distribution<double> coordinate(-3, 3);
  for (int i = 0; i < 2000; ++i) {
    const SpecPoint point{coordinate(random), coordinate(random), coordinate(random)};
    const SpecBounds bounds = field.bounds(point);
    const octree::FieldBounds found = ours.bounds({point[0], point[1], point[2]});
    EXPECT_NEAR(found.upper, bounds.upper, 1e-5);
    EXPECT_NEAR(found.lower * found.lower, bounds.lower * bounds.lower, 1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, SpecFieldTest, testing::ValuesIn(samples()), sample_name);

}  // namespace
}  // namespace planetree::golden
