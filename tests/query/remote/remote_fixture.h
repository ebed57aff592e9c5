#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "planetree/probe.h"
#include "query/model_state.h"
#include "tests/query/answer_bits.h"
#include "tests/query/sample_model.h"
#include "tests/storage/http/range_server.h"

namespace planetree::query {

/// The file of a sphere, on a server too.
class RemoteModel : public testing::Test {
 protected:
  explicit RemoteModel(unsigned levels = 5)
      : sample_(SampleModel::masked(octree::sphere(levels))),
        server_(storage::text_of(sample_.path().string())),
        queries_(random_queries(300, -1.4, 1.4)) {
    options_.max_probes = 1;
    seams_.http_limits.attempts = 2;
    seams_.http_limits.first_pause = std::chrono::milliseconds(1);
  }

  Model open() {
    auto model = ModelState::open_model(server_.url(), options_, seams_);
    if (!model) {
      ADD_FAILURE() << model.error().text;
      std::abort();
    }
    return *std::move(model);
  }

  std::vector<ClosestPoint> local_answers() const {
    const Model model = sample_.open();
    Probe probe = make_probe(model);
    std::vector<ClosestPoint> answers;
    for (const Vec3& query : queries_) answers.push_back(probe.closest_point(query));
    return answers;
  }

  void expect_local_answers(Probe& probe) {
    const std::vector<ClosestPoint> expected = local_answers();
    for (std::size_t i = 0; i < queries_.size(); ++i)
      ASSERT_EQ(bits_of(probe.closest_point(queries_[i])), bits_of(expected[i])) << i;
  }

  /// Lets the server change the bytes of one in the middle of each reply behind the first.
  static void corrupt(const storage::RangeServer::Request& request,
                      storage::RangeServer::Reply& reply) {
    if (request.number > 0)
      for (std::size_t at = 0; at < reply.body.size(); at += 500) reply.body[at] ^= 1;
  }

  SampleModel sample_;
  storage::RangeServer server_;
  std::vector<Vec3> queries_;
  OpenOptions options_;
  ModelSeams seams_;
};

}  // namespace planetree::query
