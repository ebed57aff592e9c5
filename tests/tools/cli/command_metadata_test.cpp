#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "planetree/model.h"
#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

class CommandMetadata : public Command {
 protected:
  static Json inspected(const fs::path& file) {
    const Outcome outcome = run({"inspect", file.string(), "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return Json::parse(outcome.output);
  }
};

TEST_F(CommandMetadata, IsWrittenAndTold) {
  const Outcome built =
      run({"build", "mesh.obj", "-o", "told.ptree", "--unit", "mm", "--up", "-y", "--crs",
           "EPSG:25832", "--meta", "title=A: b=c", "--meta", "k_1= ", "--json"});
  ASSERT_EQ(built.status, 0) << built.errors;
  const Json expected = {{"crs", "EPSG:25832"}, {"generator", "planetree " PLANETREE_VERSION},
                         {"k_1", " "},          {"title", "A: b=c"},
                         {"unit", "mm"},        {"up", "-y"}};
  EXPECT_EQ(inspected("told.ptree")["metadata"], expected);
  const auto model = Model::open("told.ptree");
  ASSERT_TRUE(model);
  EXPECT_EQ(Json(*model->metadata()), expected);
  const std::string text = run({"inspect", "told.ptree"}).output;
  EXPECT_NE(text.find("  crs         EPSG:25832\n"), std::string::npos) << text;
  EXPECT_EQ(run({"verify", "told.ptree", "--full"}).status, 0);
}

TEST_F(CommandMetadata, HasTheGeneratorUnlessItIsLeftOut) {
  ASSERT_EQ(run({"build", "mesh.obj", "-o", "plain.ptree"}).status, 0);
  EXPECT_EQ(inspected("plain.ptree")["metadata"].size(), 1u);
  ASSERT_EQ(run({"build", "mesh.obj", "-o", "none.ptree", "--meta", "generator="}).status, 0);
  const Json none = inspected("none.ptree");
  EXPECT_EQ(none["metadata"], Json::object());
  EXPECT_EQ(none["bytes"]["extensions"], 0);
  EXPECT_EQ(none["content_id"], inspected("plain.ptree")["content_id"]);
}

TEST_F(CommandMetadata, ThatBreaksARuleIsRefused) {
  for (const char* text : {"title", "=text", "Title=x", "title=a\nb", "title=\xff"}) {
    const Outcome outcome = run({"build", "mesh.obj", "-o", "bad.ptree", "--meta", text});
    EXPECT_NE(outcome.status, 0) << text;
    EXPECT_FALSE(fs::exists("bad.ptree"));
  }
  EXPECT_NE(run({"build", "mesh.obj", "-o", "bad.ptree", "--up", "w"}).status, 0);
}

TEST_F(CommandMetadata, ThatIsDamagedIsAnIssueAndNoAnswer) {
  ASSERT_EQ(run({"build", "mesh.obj", "-o", "told.ptree", "--unit", "mm"}).status, 0);
  flip("told.ptree", fs::file_size("told.ptree") - storage::kHeaderBytes - 2);
  const Outcome verified = run({"verify", "told.ptree", "--json"});
  EXPECT_NE(verified.status, 0);
  const Json report = Json::parse(verified.output);
  ASSERT_EQ(report["issues"].size(), 1u) << report;
  EXPECT_EQ(report["issues"][0]["code"], "EXTENSION");
  EXPECT_EQ(run({"query", "told.ptree"}, "1,2,3\n").status, 0);
  const auto model = Model::open("told.ptree");
  ASSERT_TRUE(model);
  EXPECT_EQ(model->metadata().error().code, ErrorCode::kDamaged);
}

}  // namespace
}  // namespace planetree::tools
