// Subcommands on a model that a server has.

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "tests/storage/http/range_server.h"
#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

using storage::RangeServer;

/// A statue of about 4 MB, so that most pages are behind what opening reads.
class CommandUrl : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    ASSERT_EQ(run({"generate", "big.ply", "--triangles", "400000"}).status, 0);
    ASSERT_EQ(run({"build", "big.ply", "-o", "one.ptree"}).status, 0);
    write("points.csv", "x,y,z\n1,2,3\n95,3,0.5\n-99,3,-4\n7,80,90\n-20,-90,-60\n-70,-60,50\n");
    server_ = std::make_unique<RangeServer>(text_of("one.ptree"));
  }

  std::unique_ptr<RangeServer> server_;
};

TEST_F(CommandUrl, HasTheOutputOfTheFile) {
  const std::string url = server_->url();
  const Outcome answers = run({"query", url, "points.csv"});
  EXPECT_EQ(answers.status, 0) << answers.errors;
  EXPECT_EQ(answers.output, run({"query", "one.ptree", "points.csv"}).output);
  const Json report = Json::parse(run({"inspect", url, "--json"}).output);
  const Json expected = Json::parse(run({"inspect", "one.ptree", "--json"}).output);
  for (const char* key : {"triangles", "content_id", "file_bytes", "bytes", "issues"})
    EXPECT_EQ(report[key], expected[key]) << key;
  EXPECT_EQ(run({"verify", url, "--full"}).status, 0);
}

TEST_F(CommandUrl, SaysWhyPagesDidNotCome) {
  server_->set_rule([](const RangeServer::Request& request, RangeServer::Reply& reply) {
    // Where distance pages are that opening does not read.
    if (request.first >= std::uint64_t{1} << 20 && request.first < std::uint64_t{13} << 18)
      reply.fail(400);
  });
  const Outcome answers = run({"query", server_->url(), "points.csv"});
  EXPECT_EQ(answers.status, 3);
  EXPECT_NE(answers.output.find(",degraded"), std::string::npos);
  EXPECT_NE(answers.errors.find(server_->url()), std::string::npos);
  EXPECT_NE(answers.errors.find("status 400"), std::string::npos) << answers.errors;
  EXPECT_EQ(answers.errors.find("disk"), std::string::npos) << answers.errors;
}

}  // namespace
}  // namespace planetree::tools
