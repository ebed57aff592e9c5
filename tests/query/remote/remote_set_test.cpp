// Sets whose members are on servers.

#include <memory>

#include "storage/set/set_description.h"
#include "tests/query/remote/remote_fixture.h"
#include "tests/storage/file/file_image.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::query {
namespace {

using storage::RangeServer;

/// A sphere as a set: each member on a server of its own, and the set file on one more.
class RemoteSet : public testing::Test {
 protected:
  void SetUp() override {
    const Soup soup = octree::sphere(6);
    build_soup(soup, folder_ / "model.ptree");
    BuildOptions options;
    options.member_bytes = BuildOptions::kMinMemberBytes;
    build_soup(soup, folder_ / "built.ptreeset", options);
    auto set = storage::SetDescription::parse(storage::read_bytes(folder_ / "built.ptreeset"));
    ASSERT_TRUE(set);
    ASSERT_GE(set->members.size(), 8u);
    for (storage::SetMember& member : set->members) {
      members_.push_back(std::make_unique<RangeServer>(
          storage::text_of((folder_ / member.address.c_str()).string())));
      member.address = members_.back()->url();
    }
    const std::string text = set->text();
    storage::write_bytes(local(), std::as_bytes(std::span(text)));
    set_file_ = std::make_unique<RangeServer>(text);
    options_.max_probes = 1;
    seams_.http_limits.attempts = 2;
    seams_.http_limits.first_pause = std::chrono::milliseconds(1);
  }

  std::filesystem::path local() const { return folder_ / "local.ptreeset"; }
  std::string url() const { return set_file_->url() + "set"; }
  Model open(const std::filesystem::path& path) {
    auto model = ModelState::open_model(path, options_, seams_);
    EXPECT_TRUE(model) << model.error().text;
    return *std::move(model);
  }

  storage::TemporaryDirectory folder_;
  std::vector<std::unique_ptr<RangeServer>> members_;
  std::unique_ptr<RangeServer> set_file_;
  OpenOptions options_;
  ModelSeams seams_;
};

TEST_F(RemoteSet, AnswersAsTheFile) {
  const Model file = open(folder_ / "model.ptree");
  Probe of_file = make_probe(file);
  for (const std::filesystem::path& path : {local(), std::filesystem::path(url())}) {
    const Model set = open(path);
    Probe of_set = make_probe(set);
    for (const Vec3& query : random_queries(500, -1.4, 1.4))
      ASSERT_EQ(bits_of(of_set.closest_point(query)), bits_of(of_file.closest_point(query)));
    unsigned requests = 0;
    for (const auto& member : members_) requests += member->requests();
    EXPECT_GT(set.stats().http_requests, 8u);
    EXPECT_LE(set.stats().http_requests, requests);
    EXPECT_FALSE(set.read_error());
  }
}

// Opening asks for what is before the pages and for the first pages, not for each member.
TEST_F(RemoteSet, OpensMembersWhenTheyAreRead) {
  const Model set = open(url());
  std::size_t asked = 0;
  for (const auto& member : members_) asked += member->requests() > 0 ? 1 : 0;
  EXPECT_GE(asked, 2u);
  EXPECT_LT(asked, members_.size());
}

TEST_F(RemoteSet, HasNoMoreMemoryThanItsBudget) {
  options_.memory_budget_bytes = 0;
  const auto refused = ModelState::open_model(url(), options_, seams_);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kNoMemory);
  options_.memory_budget_bytes = *ModelState::min_budget_bytes(url(), options_);
  // Eight clusters for each member, and its connections.
  EXPECT_GT(options_.memory_budget_bytes, members_.size() * (std::size_t{2} << 20));
  const Model set = open(url());
  Probe probe = make_probe(set);
  const Model file = open(folder_ / "model.ptree");
  Probe of_file = make_probe(file);
  for (const Vec3& query : random_queries(200, -1.4, 1.4))
    ASSERT_EQ(bits_of(probe.closest_point(query)), bits_of(of_file.closest_point(query)));
}

TEST_F(RemoteSet, IsDegradedWhereAServerFails) {
  const Model file = open(folder_ / "model.ptree");
  Probe of_file = make_probe(file);
  members_[4]->set_rule(
      [](const RangeServer::Request&, RangeServer::Reply& reply) { reply.fail(404); });
  const Model set = open(url());
  Probe of_set = make_probe(set);
  std::size_t degraded = 0;
  for (const Vec3& query : random_queries(300, -1.4, 1.4)) {
    const ClosestPoint answer = of_set.closest_point(query);
    const ClosestPoint expected = of_file.closest_point(query);
    if (answer.status == Status::kExact) {
      ASSERT_EQ(bits_of(answer), bits_of(expected));
      continue;
    }
    ++degraded;
    ASSERT_LE(answer.lower, expected.upper);
    ASSERT_GE(answer.upper, expected.lower);
  }
  EXPECT_GT(degraded, 5u);
  ASSERT_TRUE(set.read_error());
  EXPECT_NE(std::string(set.read_error()->text).find("member"), std::string::npos);
}

// A set file on a server does not lead to files of this machine.
TEST_F(RemoteSet, ReadsNoFileOfThisMachine) {
  storage::SetDescription set;
  set.members.push_back({.address = (folder_ / "model.ptree").string(), .bytes = 10});
  set_file_->set_object(set.text(), 2);
  const auto refused = ModelState::open_model(url(), options_, seams_);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kUnsupported);
}

}  // namespace
}  // namespace planetree::query
