// Reads of an object by ranges: which requests are sent, and what a server may do to them.

#include <algorithm>
#include <atomic>
#include <thread>

#include "storage/http/http_url.h"
#include "tests/storage/http/http_object.h"

namespace planetree::storage {
namespace {

using HttpSourceTest = HttpObject;

TEST_F(HttpSourceTest, OpensByOneRequest) {
  const auto source = open();
  ASSERT_TRUE(source);
  EXPECT_EQ(source->size_bytes(), kBytes);
  EXPECT_TRUE(source->is_remote());
  expect_bytes(*source, 0, 2 * kCluster);
  EXPECT_EQ(server_.requests(), 1u);
  EXPECT_EQ(server_.bytes(), 2 * kCluster);
  EXPECT_EQ(source->stats().requests, 1u);
  EXPECT_EQ(source->stats().bytes, 2 * kCluster);
}

TEST_F(HttpSourceTest, GetsNeighboursByOneRequest) {
  const auto source = open();
  expect_bytes(*source, 5 * kCluster + 7, 30'000);
  expect_bytes(*source, 5 * kCluster + 90'000, 50'000);
  EXPECT_EQ(server_.requests(), 2u);
  // Across two clusters.
  expect_bytes(*source, 9 * kCluster - 10, 20);
  EXPECT_EQ(server_.requests(), 3u);
  EXPECT_EQ(server_.bytes(), 5 * kCluster);
}

TEST_F(HttpSourceTest, ReadsTheEndAndNothingBehindIt) {
  const auto source = open();
  expect_bytes(*source, kBytes - 1000, 1000);
  const auto behind = read(*source, kBytes - 10, 11);
  ASSERT_FALSE(behind);
  EXPECT_EQ(behind.error().code, ErrorCode::kTruncated);
}

TEST_F(HttpSourceTest, ReadsFromFrontToBackByFewRequests) {
  const auto source = open();
  for (std::uint64_t at = 0; at < kBytes; at += 10'000)
    expect_bytes(*source, at, std::min<std::size_t>(10'000, kBytes - at));
  EXPECT_LE(server_.requests(), 9u);
  EXPECT_EQ(server_.bytes(), kBytes);
}

TEST_F(HttpSourceTest, PrefetchesByRequestsAtOnce) {
  const auto source = open();
  server_.set_rule(
      [](const RangeServer::Request&, RangeServer::Reply& reply) { reply.delay_ms = 100; });
  const ByteRange ranges[] = {{4 * kCluster, 10}, {12 * kCluster, 10}, {8 * kCluster, 10}};
  source->prefetch(ranges);
  EXPECT_EQ(server_.requests(), 4u);
  EXPECT_EQ(server_.most_at_once(), 3u);
  for (const ByteRange& range : ranges) expect_bytes(*source, range.offset, 10);
  EXPECT_EQ(server_.requests(), 4u);
}

TEST_F(HttpSourceTest, TriesWithoutARequest) {
  const auto source = open();
  std::byte out[10];
  EXPECT_TRUE(source->try_read(100, out, {}));
  EXPECT_FALSE(source->try_read(7 * kCluster, out, {}));
  EXPECT_EQ(server_.requests(), 1u);
}

TEST_F(HttpSourceTest, ManyThreadsShareRequests) {
  const auto source = open();
  server_.set_rule(
      [](const RangeServer::Request&, RangeServer::Reply& reply) { reply.delay_ms = 50; });
  std::vector<std::thread> threads;
  std::atomic<unsigned> read_count{0};
  for (unsigned i = 0; i < 8; ++i)
    threads.emplace_back([&, i] {
      const auto out = read(*source, 6 * kCluster + 1000 * i, 1000);
      read_count += out && *out == object_.substr(6 * kCluster + 1000 * i, 1000);
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(read_count, 8u);
  EXPECT_EQ(server_.requests(), 2u);
}

TEST_F(HttpSourceTest, EvictsClustersAndReadsThemAgain) {
  for (unsigned seed = 2; seed <= 5; ++seed) object_ += make_object(seed);
  server_.set_object(object_, 1);
  const auto source = open();
  for (int round = 0; round < 2; ++round)
    for (std::uint64_t cluster = 100; cluster-- > 0;)
      expect_bytes(*source, cluster * kCluster + cluster, 1000);
  EXPECT_GT(server_.requests(), 150u);
}

TEST_F(HttpSourceTest, RepeatsWhatMayPass) {
  const auto fail_once = [this](const RangeServer::Rule& rule) {
    const unsigned before = server_.requests();
    server_.set_rule(
        [before, rule](const RangeServer::Request& request, RangeServer::Reply& reply) {
          if (request.number == before + 1) rule(request, reply);
        });
    const auto source = open();
    ASSERT_TRUE(source);
    expect_bytes(*source, 5 * kCluster, 5000);
    EXPECT_EQ(server_.requests(), before + 3);
  };
  using Request = RangeServer::Request;
  using Reply = RangeServer::Reply;
  fail_once([](const Request&, Reply& reply) { reply.fail(503); });
  fail_once([](const Request&, Reply& reply) { reply.fail(500); });
  fail_once([](const Request&, Reply& reply) {
    reply.fail(429);
    reply.set("Retry-After", "0");
  });
  fail_once([](const Request&, Reply& reply) { reply.sent_bytes = 70'000; });
  fail_once([](const Request&, Reply& reply) { reply.sent_bytes = 0; });
  fail_once([](const Request&, Reply& reply) { reply.closes_at_once = true; });
  fail_once([](const Request&, Reply& reply) { reply.body += reply.body; });
  fail_once([](const Request&, Reply& reply) { reply.set("Content-Range", "bytes 0-9/5243880"); });
}

TEST_F(HttpSourceTest, GivesUpAfterItsAttemptsAndSucceedsLater) {
  const auto source = open();
  server_.set_rule([](const RangeServer::Request&, RangeServer::Reply& reply) { reply.fail(503); });
  const Error error = read_error(*source, 5 * kCluster);
  EXPECT_EQ(error.code, ErrorCode::kReadFailed);
  EXPECT_STREQ(error.text,
               "the server does not give the file (status 503); check the server and try again "
               "later");
  EXPECT_EQ(server_.requests(), 1 + options_.limits.attempts);
  server_.set_rule({});
  expect_bytes(*source, 5 * kCluster, 100);
}

TEST_F(HttpSourceTest, RefusesAnotherObject) {
  const auto source = open();
  expect_bytes(*source, 5 * kCluster, 100);
  server_.set_object(make_object(2), 2);
  const Error error = read_error(*source, 9 * kCluster);
  EXPECT_EQ(error.code, ErrorCode::kReadFailed);
  EXPECT_NE(std::string(error.text).find("has another file"), std::string::npos) << error.text;
  const unsigned requests = server_.requests();
  // For good, even if the first one comes back.
  server_.set_object(object_, 1);
  EXPECT_STREQ(read_error(*source, 9 * kCluster).text, error.text);
  EXPECT_EQ(server_.requests(), requests);
  expect_bytes(*source, 5 * kCluster, 100);
}

TEST_F(HttpSourceTest, SeesAnotherObjectWithoutTheHelpOfTheServer) {
  using Change = std::function<void(RangeServer::Reply&)>;
  const Change changes[] = {[](RangeServer::Reply& reply) { reply.set("ETag", "\"other\""); },
                            [](RangeServer::Reply& reply) { reply.remove("ETag"); },
                            [](RangeServer::Reply& reply) {
                              reply.set("Content-Range", "bytes 2359296-2621439/9999999");
                            },
                            [](RangeServer::Reply& reply) { reply.fail(416); },
                            [](RangeServer::Reply& reply) {
                              reply.status = 200;
                              reply.remove("Content-Range");
                              reply.set("ETag", "\"other\"");
                            }};
  for (const Change& change : changes) {
    server_.set_rule({});
    const auto source = open();
    server_.set_rule(
        [&change](const RangeServer::Request&, RangeServer::Reply& reply) { change(reply); });
    const Error error = read_error(*source, 9 * kCluster);
    EXPECT_NE(std::string(error.text).find("has another file"), std::string::npos) << error.text;
  }
}

TEST_F(HttpSourceTest, AsksForTheSameObject) {
  std::atomic<unsigned> matched{0}, unmodified{0};
  server_.set_rule([&](const RangeServer::Request& request, RangeServer::Reply& reply) {
    matched += request.contains("If-Match: \"v1\"");
    unmodified += request.contains("If-Unmodified-Since: Fri, 27 Nov 2026 00:00:00 GMT");
    reply.set("Last-Modified", "Fri, 27 Nov 2026 00:00:00 GMT");
    if (request.number >= 2) reply.set("ETag", "W/\"weak\"");
  });
  expect_bytes(*open(), 5 * kCluster, 100);
  expect_bytes(*open(), 5 * kCluster, 100);
  EXPECT_EQ(matched, 1u);
  EXPECT_EQ(unmodified, 1u);
}

TEST_F(HttpSourceTest, DoesNotOpenWhatItCannotRead) {
  const auto expect = [this](ErrorCode code, unsigned requests, const char* text,
                             const std::function<void(RangeServer::Reply&)>& change) {
    const unsigned before = server_.requests();
    server_.set_rule(
        [&change](const RangeServer::Request&, RangeServer::Reply& reply) { change(reply); });
    const Error error = open_error();
    EXPECT_EQ(error.code, code) << error.text;
    EXPECT_NE(std::string(error.text).find(text), std::string::npos) << error.text;
    EXPECT_EQ(server_.requests() - before, requests) << text;
  };
  using Reply = RangeServer::Reply;
  expect(ErrorCode::kNotFound, 1, "status 404", [](Reply& reply) { reply.fail(404); });
  expect(ErrorCode::kPermission, 1, "status 403", [](Reply& reply) { reply.fail(403); });
  expect(ErrorCode::kReadFailed, 1, "status 412", [](Reply& reply) { reply.fail(412); });
  expect(ErrorCode::kReadFailed, 3, "status 502", [](Reply& reply) { reply.fail(502); });
  expect(ErrorCode::kNotPlanetree, 1, "empty file", [](Reply& reply) { reply.fail(416); });
  expect(ErrorCode::kUnsupported, 1, "not ranges", [](Reply& reply) { reply.status = 200; });
  expect(ErrorCode::kUnsupported, 1, "encodes",
         [](Reply& reply) { reply.set("Content-Encoding", "gzip"); });
  expect(ErrorCode::kReadFailed, 3, "another range",
         [](Reply& reply) { reply.remove("Content-Range"); });
  expect(ErrorCode::kReadFailed, 3, "another range",
         [](Reply& reply) { reply.set("Content-Range", "bytes 1-524288/5243880"); });
}

TEST_F(HttpSourceTest, NoServerIsAnError) {
  options_.limits.attempts = 2;
  const auto source = open_source("http://127.0.0.1:1/model.ptree", options_);
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, ErrorCode::kReadFailed);
}

TEST(HttpUrl, IsToldFromAPath) {
  EXPECT_TRUE(is_http_url("http://host/file.ptree"));
  EXPECT_TRUE(is_http_url("HTTPS://host/file.ptree"));
  for (const char* path : {"model.ptree", "http:/host", "ftp://host/file", "httpx://host", ""})
    EXPECT_FALSE(is_http_url(path)) << path;
}

TEST(HttpUrl, IsShownWithoutSecrets) {
  EXPECT_EQ(shown_url("https://host:80/a/b.ptree"), "https://host:80/a/b.ptree");
  EXPECT_EQ(shown_url("https://name:word@host/b@c.ptree?sign=x#y"), "https://host/b@c.ptree");
  EXPECT_EQ(shown_url("http://host?a@b/c"), "http://host");
}

}  // namespace
}  // namespace planetree::storage
