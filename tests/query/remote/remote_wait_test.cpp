// The wait limit of queries of a model whose server does not reply.

#include <atomic>
#include <chrono>
#include <thread>

#include "tests/query/remote/remote_fixture.h"

namespace planetree::query {
namespace {

using storage::RangeServer;

// The server holds its replies back while `is_silent`. A request would wait for a minute.
class SilentServer : public RemoteModel {
 protected:
  // Far beyond any wait limit here, and far below the time of a request.
  static constexpr std::chrono::seconds kSoon{10};

  SilentServer() : RemoteModel(7) {
    queries_.resize(4);
    for (const auto limit : {&storage::HttpLimits::max_total, &storage::HttpLimits::max_stall})
      seams_.http_limits.*limit = std::chrono::minutes(1);
    options_.wait_limit_ms = 50;
    server_.set_rule([this](const RangeServer::Request&, RangeServer::Reply&) {
      while (is_silent) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
  }
  ~SilentServer() override { is_silent = false; }

  void expect_degraded(const ClosestPoint& answer, const Vec3& query) const {
    EXPECT_EQ(answer.status, Status::kDegraded);
    EXPECT_TRUE(sample_.interval_holds(answer, query));
  }

  std::atomic<bool> is_silent{false};
};

TEST_F(SilentServer, AQueryEndsAtItsWaitLimit) {
  const Model model = open();
  Probe probe = make_probe(model);
  is_silent = true;
  const auto start = std::chrono::steady_clock::now();
  for (const Vec3& query : queries_) expect_degraded(probe.closest_point(query), query);
  EXPECT_EQ(probe.contains({0.999, 0, 0}).status, Status::kDegraded);
  EXPECT_LT(std::chrono::steady_clock::now() - start, kSoon);
  is_silent = false;
  expect_local_answers(probe);
}

TEST_F(SilentServer, ABatchEndsAtTheWaitLimits) {
  const Model model = open();
  Probe probe = make_probe(model);
  is_silent = true;
  std::vector<ClosestPoint> answers(queries_.size());
  const auto start = std::chrono::steady_clock::now();
  probe.closest_points(queries_, answers);
  EXPECT_LT(std::chrono::steady_clock::now() - start, kSoon);
  for (std::size_t i = 0; i < queries_.size(); ++i) expect_degraded(answers[i], queries_[i]);
  is_silent = false;
}

}  // namespace
}  // namespace planetree::query
