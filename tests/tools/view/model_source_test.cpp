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
  ASSERT_EQ(run({"build", "mesh.obj", "-o", "lean.ptree", "--layers", "distance"}).status, kDone);
  const auto source = ModelSource::open("lean.ptree", std::uint64_t{16} << 20);
  ASSERT_TRUE(source) << source.error().text;
  const Json answer = settled_answer(**source, {{3, 3, 50}, 0});
  EXPECT_EQ(answer["status"], "exact");
  EXPECT_EQ(answer["side"], "unknown");
}

}  // namespace
}  // namespace planetree::tools
