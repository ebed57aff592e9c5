#include "tools/view/model_source.h"

#include <gtest/gtest.h>

#include "tests/tools/cli/command_fixture.h"
#include "tests/tools/view/settled_answer.h"

namespace planetree::tools {
namespace {

using ModelSourceTest = Command;

TEST_F(ModelSourceTest, AnswersWithContactsAndNoInstance) {
  const auto source = ModelSource::open("tree.ptree", std::uint64_t{16} << 20);
  ASSERT_TRUE(source) << source.error().text;
  const Json answer = settled_answer(**source, {{3, 3, 50}, 100});
  EXPECT_EQ(answer["status"], "exact");
  EXPECT_FALSE(answer.contains("instance"));
  EXPECT_EQ(answer["distance"], answer["contacts"][0]["distance"]);
}

TEST_F(ModelSourceTest, AnswersExactlyWithoutASideLayer) {
  write("solid.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  ASSERT_EQ(run({"build", "solid.obj", "-o", "lean.ptree", "--layers", "distance"}).status, kDone);
  const auto source = ModelSource::open("lean.ptree", std::uint64_t{16} << 20);
  ASSERT_TRUE(source) << source.error().text;
  const Json answer = settled_answer(**source, {{0.1, 0.1, -2}, 0});
  EXPECT_EQ(answer["status"], "exact");
  EXPECT_EQ(answer["side"], "unknown");
  EXPECT_TRUE(answer["normal"].is_null());
}

}  // namespace
}  // namespace planetree::tools
