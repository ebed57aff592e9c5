// Models opened by URL: answers, requests, and servers that fail or lie.

#include <algorithm>

#include "tests/query/eventually.h"
#include "tests/query/remote/remote_fixture.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::query {
namespace {

using storage::RangeServer;

bool error_says(const Model& model, const char* text) {
  const auto error = model.read_error();
  return error && std::string(error->text).find(text) != std::string::npos;
}

class SmallRemoteModel : public RemoteModel {};

TEST_F(SmallRemoteModel, HasTheAnswersOfTheFile) {
  const Model model = open();
  Probe probe = make_probe(model);
  expect_local_answers(probe);
  EXPECT_EQ(model.stats().http_requests, server_.requests());
  EXPECT_EQ(model.stats().http_bytes, server_.bytes());
  EXPECT_FALSE(model.read_error());
}

TEST_F(SmallRemoteModel, AnswersBatchesByThreads) {
  options_.batch_threads = 2;
  options_.fetch_threads = 2;
  const Model model = open();
  Probe probe = make_probe(model);
  std::vector<ClosestPoint> answers(queries_.size());
  probe.closest_points(queries_, answers);
  const std::vector<ClosestPoint> expected = local_answers();
  for (std::size_t i = 0; i < queries_.size(); ++i)
    ASSERT_EQ(bits_of(answers[i]), bits_of(expected[i])) << i;
}

TEST_F(SmallRemoteModel, HasNoneOfTheDetailsOfAFile) {
  const Model model = sample_.open();
  Probe probe = make_probe(model);
  (void)probe.closest_point(queries_[0]);
  EXPECT_EQ(model.stats().http_requests, 0u);
  EXPECT_FALSE(model.read_error());
}

TEST_F(SmallRemoteModel, RefusesAURLThatIsNone) {
  server_.set_rule([](const RangeServer::Request&, RangeServer::Reply& reply) { reply.fail(404); });
  const auto model = ModelState::open_model(server_.url(), options_, seams_);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::kNotFound);
}

// Of some megabytes, so that most pages are behind the first request.
class RemoteModelOfParts : public RemoteModel {
 protected:
  RemoteModelOfParts() : RemoteModel(7) {
    const std::vector<Vec3> near = random_queries(40, -1, 1);
    queries_.clear();
    for (const Vec3& query : near) {
      const double length = std::sqrt(query.x * query.x + query.y * query.y + query.z * query.z);
      queries_.push_back({query.x / length, query.y / length, query.z / length});
    }
  }

  // The status of each query, in one round.
  std::size_t count_degraded(Probe& probe) const {
    return static_cast<std::size_t>(
        std::count_if(queries_.begin(), queries_.end(), [&probe](const Vec3& query) {
          return probe.closest_point(query).status == Status::kDegraded;
        }));
  }
};

TEST_F(RemoteModelOfParts, OpensByFewRequests) {
  const Model model = open();
  EXPECT_LE(server_.requests(), 3u);
  EXPECT_LE(server_.bytes(), std::uint64_t{1} << 20);
}

TEST_F(RemoteModelOfParts, ANearQueryTakesFewRequests) {
  const Model model = open();
  Probe probe = make_probe(model);
  const unsigned opened = server_.requests();
  EXPECT_EQ(probe.closest_point(queries_[0]).status, Status::kExact);
  EXPECT_LE(server_.requests(), opened + 2);
}

// A fresh model for each point. The file has two levels of pages below its first one.
TEST_F(RemoteModelOfParts, OpeningAndANearQueryTakeFewRoundTrips) {
  for (std::size_t i = 0; i < 10; ++i) {
    const Model model = open();
    Probe probe = make_probe(model);
    const std::uint64_t opened = model.stats().http_rounds;
    EXPECT_LE(opened, 2u);
    EXPECT_EQ(probe.closest_point(queries_[i]).status, Status::kExact);
    EXPECT_LE(model.stats().http_rounds, opened + 2) << i;
  }
}

TEST_F(RemoteModelOfParts, ABatchSharesRequests) {
  queries_ = random_queries(1000, -1, 1);
  const Model model = open();
  Probe probe = make_probe(model);
  std::vector<ClosestPoint> answers(queries_.size());
  probe.closest_points(queries_, answers);
  EXPECT_LT(server_.requests(), model.stats().pages_read / 10);
  const std::vector<ClosestPoint> expected = local_answers();
  for (std::size_t i = 0; i < queries_.size(); ++i)
    ASSERT_EQ(bits_of(answers[i]), bits_of(expected[i])) << i;
  // The looks ahead are no answers, and leave no requests to fetch threads.
  EXPECT_EQ(model.stats().degraded_answers, 0u);
  EXPECT_EQ(model.stats().fetch_requests, 0u);
}

TEST_F(RemoteModelOfParts, ABatchEndsIfTheServerDoes) {
  const Model model = open();
  Probe probe = make_probe(model);
  server_.set_rule([](const RangeServer::Request&, RangeServer::Reply& reply) { reply.fail(404); });
  std::vector<ClosestPoint> answers(queries_.size());
  probe.closest_points(queries_, answers);
  for (std::size_t i = 0; i < queries_.size(); ++i)
    EXPECT_TRUE(sample_.interval_holds(answers[i], queries_[i]));
  EXPECT_TRUE(error_says(model, "status 404"));
}

TEST_F(RemoteModelOfParts, APageIsLateAndComesLater) {
  const Model model = open();
  Probe probe = make_probe(model);
  server_.set_rule([](const RangeServer::Request&, RangeServer::Reply& reply) { reply.fail(503); });
  EXPECT_GT(count_degraded(probe), 0u);
  for (const Vec3& query : queries_)
    EXPECT_TRUE(sample_.interval_holds(probe.closest_point(query, {.wait = Wait::kNever}), query));
  EXPECT_EQ(model.stats().quarantined_pages, 0u);
  EXPECT_GT(model.stats().waits_given_up, 0u);
  EXPECT_TRUE(error_says(model, "http://127.0.0.1:"));
  EXPECT_TRUE(error_says(model, "status 503"));
  server_.set_rule({});
  expect_local_answers(probe);
}

TEST_F(RemoteModelOfParts, AQueryThatDoesNotWaitIsRefinedLater) {
  const Model model = open();
  Probe probe = make_probe(model);
  const std::vector<ClosestPoint> expected = local_answers();
  for (std::size_t i = 0; i < 5; ++i) {
    ASSERT_TRUE(eventually([&] {
      return bits_of(probe.closest_point(queries_[i], {.wait = Wait::kNever})) ==
             bits_of(expected[i]);
    }));
  }
}

TEST_F(RemoteModelOfParts, APageWithWrongBytesIsRefused) {
  const Model model = open();
  Probe probe = make_probe(model);
  server_.set_rule(corrupt);
  EXPECT_GT(count_degraded(probe), 0u);
  EXPECT_GT(model.stats().quarantined_pages, 0u);
  EXPECT_TRUE(error_says(model, "checksum is wrong")) << model.read_error()->text;
}

TEST_F(RemoteModelOfParts, AConnectionThatCorruptsBytesOnceIsForgiven) {
  const Model model = open();
  Probe probe = make_probe(model);
  const unsigned opened = server_.requests();
  server_.set_rule([opened](const RangeServer::Request& request, RangeServer::Reply& reply) {
    if (request.number == opened) corrupt(request, reply);
  });
  expect_local_answers(probe);
  EXPECT_EQ(model.stats().quarantined_pages, 0u);
}

TEST_F(RemoteModelOfParts, AnotherObjectIsNeverMixedIn) {
  const Model model = open();
  Probe probe = make_probe(model);
  const SampleModel other = SampleModel::masked(octree::sphere(6));
  server_.set_object(storage::text_of(other.path().string()), 2);
  EXPECT_GT(count_degraded(probe), 0u);
  EXPECT_TRUE(error_says(model, "has another file")) << model.read_error()->text;
  EXPECT_EQ(model.stats().quarantined_pages, 0u);
}

TEST_F(RemoteModelOfParts, ACacheOnDiskSparesRequests) {
  const storage::TemporaryDirectory folder;
  options_.http_cache = folder / "cache";
  {
    const Model model = open();
    Probe probe = make_probe(model);
    expect_local_answers(probe);
  }
  const unsigned before = server_.requests();
  EXPECT_GT(before, 3u);
  const Model model = open();
  Probe probe = make_probe(model);
  expect_local_answers(probe);
  EXPECT_EQ(server_.requests(), before + 1);
  EXPECT_GT(model.stats().http_cached_bytes, 0u);
}

TEST_F(RemoteModelOfParts, ACacheThatIsTooSmallIsRefused) {
  const storage::TemporaryDirectory folder;
  options_.http_cache = folder / "cache";
  options_.http_cache_bytes = 1000;
  const auto model = ModelState::open_model(server_.url(), options_, seams_);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::kBadArgument);
}

}  // namespace
}  // namespace planetree::query
