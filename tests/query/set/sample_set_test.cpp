// The set of format-spec/set-v1/samples: every later release reads it.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "planetree/metadata.h"
#include "storage/set/set_description.h"
#include "tests/query/sample_model.h"
#include "tests/storage/file/file_image.h"

namespace planetree::query {
namespace {

const std::filesystem::path kSetSamples = PLANETREE_SOURCE_DIR "/format-spec/set-v1/samples";

TEST(SampleSet, HasTheMembersThatItNames) {
  const auto set =
      storage::SetDescription::parse(storage::read_bytes(kSetSamples / "sphere.ptreeset"));
  ASSERT_TRUE(set) << set.error().text;
  ASSERT_EQ(set->members.size(), 4u);
  std::uint32_t pages = 0;
  for (const storage::SetMember& member : set->members) {
    const storage::Bytes bytes = storage::read_bytes(kSetSamples / member.address);
    EXPECT_EQ(bytes.size(), member.bytes);
    EXPECT_EQ(storage::hash128(bytes), member.hash);
    pages += member.pages;
  }
  const auto model = Model::open(kSetSamples / "sphere.ptreeset");
  ASSERT_TRUE(model) << model.error().text;
  EXPECT_EQ(model->info().content_id[0], set->content_id.low);
  EXPECT_EQ(model->info().content_id[1], set->content_id.high);
  EXPECT_EQ(model->info().pages, pages);
}

// A sphere of radius 100 whose corners lie on it.
TEST(SampleSet, IsASphere) {
  const auto model = Model::open(kSetSamples / "sphere.ptreeset");
  ASSERT_TRUE(model) << model.error().text;
  EXPECT_TRUE(model->info().watertight());
  Probe probe = make_probe(*model);
  for (const Vec3& query : random_queries(500, -150, 150)) {
    const double radius = std::sqrt(query.x * query.x + query.y * query.y + query.z * query.z);
    const ClosestPoint answer = probe.closest_point(query);
    EXPECT_EQ(answer.status, Status::kExact);
    EXPECT_NEAR(answer.distance, std::abs(radius - 100), 0.2);
    if (std::abs(radius - 100) > 0.2) {
      EXPECT_EQ(answer.side, radius < 100 ? Side::kInside : Side::kOutside);
    }
  }
}

}  // namespace
}  // namespace planetree::query
