#include "tools/view/viewed_kind.h"

#include <gtest/gtest.h>

#include "tests/tools/view/scene_fixture.h"

namespace planetree::tools {
namespace {

using ViewedKindTest = SceneFiles;

TEST_F(ViewedKindTest, GoesByTheFirstBytes) {
  fs::copy_file("tree.ptree", "model.json");
  fs::copy_file("scene.json", "scene.ptree");
  fs::copy_file("scene.json", "scene");
  EXPECT_EQ(*viewed_kind("tree.ptree"), ViewedKind::kModel);
  EXPECT_EQ(*viewed_kind("model.json"), ViewedKind::kModel);
  EXPECT_EQ(*viewed_kind("scene.json"), ViewedKind::kScene);
  EXPECT_EQ(*viewed_kind("scene.ptree"), ViewedKind::kScene);
  EXPECT_EQ(*viewed_kind("scene"), ViewedKind::kScene);
  write("blank", "\n\r\n \t{}");
  EXPECT_EQ(*viewed_kind("blank"), ViewedKind::kScene);
}

// What reads the file says what is wrong with it.
TEST_F(ViewedKindTest, GoesByTheExtensionOfADamagedFile) {
  flip("tree.ptree", 0);
  EXPECT_EQ(*viewed_kind("tree.ptree"), ViewedKind::kModel);
  write("EMPTY.JSON", "");
  EXPECT_EQ(*viewed_kind("EMPTY.JSON"), ViewedKind::kScene);
}

TEST_F(ViewedKindTest, NamesBothKindsIfItIsNeither) {
  const auto kind = viewed_kind("mesh.obj");
  ASSERT_FALSE(kind);
  EXPECT_EQ(kind.error().code, ErrorCode::kBadInput);
  EXPECT_NE(std::string(kind.error().text).find(".ptree file"), std::string::npos);
  EXPECT_NE(std::string(kind.error().text).find("scene file"), std::string::npos);
  EXPECT_EQ(viewed_kind("none.ptree").error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace planetree::tools
