#include "tools/view/view_router.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "tests/tools/view/sample_source.h"

namespace planetree::tools {
namespace {

class ViewRouterTest : public testing::Test {
 protected:
  ViewReply get(const std::string& target, std::vector<std::string_view> hosts = {kHost},
                std::vector<std::string_view> origins = {}, std::string_view method = "GET") {
    return router_.respond({method, target, hosts, origins});
  }
  static std::string at(const std::string& rest) { return "/" + std::string(kSampleToken) + rest; }

  static constexpr std::string_view kHost = "127.0.0.1:8080";
  SampleSource source_;
  ViewRouter router_{kSampleToken, {"127.0.0.1", "::1"}, 8080, kSampleFiles, source_};
};

TEST_F(ViewRouterTest, ServesThePageAndItsFiles) {
  EXPECT_EQ(get(at("/")).body, "<!doctype html>");
  EXPECT_EQ(get(at("/")).type, "text/html");
  EXPECT_EQ(get(at("/view.js")).body, "main()");
  EXPECT_EQ(get(at("/view.js")).status, 200);
}

TEST_F(ViewRouterTest, ServesData) {
  EXPECT_EQ(get(at("/info")).body, "info");
  EXPECT_EQ(get(at("/stats")).body, "stats");
  EXPECT_EQ(get(at("/timeline")).body, "null");
  EXPECT_EQ(get(at("/pages")).body.size(), 3u);
  EXPECT_EQ(get(at("/shape?discs=100")).body, "shape of 100");
  EXPECT_EQ(get(at("/shape?discs=9&x=1&y=2&z=3&dx=0&dy=0&dz=-1&cosine=0.5")).body,
            "shape of 9 from an eye");
  EXPECT_EQ(get(at("/query?x=1&y=-2.5e0&z=3&within=0")).body, "answer at -2.500000");
}

TEST_F(ViewRouterTest, ServesNothingWithoutTheToken) {
  for (const char* target :
       {"", "/", "/info", "//", "/view.js", "info", "*", "http://127.0.0.1:8080/",
        "/0123456789abcdef0123456789abcdee/", "/0123456789abcdef0123456789abcde/",
        "/0123456789abcdef0123456789abcdef", "/0123456789ABCDEF0123456789ABCDEF/"})
    EXPECT_EQ(get(target).status, 404) << target;
}

TEST_F(ViewRouterTest, ServesNoOtherPath) {
  for (const char* rest : {"/nothing", "/../etc/passwd", "/%2e%2e/", "//info", "/info/",
                           "/view.js/", "/./view.js", "/shape/", "/INFO", "/info%00"})
    EXPECT_EQ(get(at(rest)).status, 404) << rest;
}

TEST_F(ViewRouterTest, RefusesForeignHosts) {
  for (const std::string_view host :
       {"evil.example", "evil.example:8080", "127.0.0.1", "", "127.0.0.1:8081",
        "127.0.0.1:8080.evil.example", "127.0.0.2:8080", "10.0.0.1:8080"})
    EXPECT_EQ(get(at("/"), {host}).status, 403) << host;
  EXPECT_EQ(get(at("/"), {}).status, 403);
  EXPECT_EQ(get(at("/"), {kHost, kHost}).status, 403);
  for (const std::string_view host : {"localhost:8080", "LocalHost:8080", "[::1]:8080"})
    EXPECT_EQ(get(at("/"), {host}).status, 200) << host;
}

TEST_F(ViewRouterTest, KnowsNumbersAloneIfItListensAtAllAddresses) {
  const ViewRouter router(kSampleToken, {"0.0.0.0"}, 8080, kSampleFiles, source_);
  const auto status = [&](std::string_view host) {
    return router.respond({"GET", at("/"), {host}, {}}).status;
  };
  EXPECT_EQ(status("192.168.1.7:8080"), 200);
  EXPECT_EQ(status("[fe80::1]:8080"), 200);
  EXPECT_EQ(status("rebound.example:8080"), 403);
  EXPECT_EQ(status("192.168.1.7:80"), 403);
  EXPECT_EQ(status(":8080"), 403);
}

TEST_F(ViewRouterTest, RefusesForeignOrigins) {
  for (const std::string_view origin : {"http://evil.example", "null", "https://127.0.0.1:8080",
                                        "http://127.0.0.1:8081", "http://127.0.0.1:8080.evil", ""})
    EXPECT_EQ(get(at("/info"), {kHost}, {origin}).status, 403) << origin;
  EXPECT_EQ(get(at("/info"), {kHost}, {"http://127.0.0.1:8080"}).status, 200);
  EXPECT_EQ(get(at("/info"), {kHost}, {"http://127.0.0.1:8080", "http://evil"}).status, 403);
}

TEST_F(ViewRouterTest, RefusesOtherMethods) {
  for (const std::string_view method : {"POST", "HEAD", "PUT", "DELETE", "OPTIONS", "get", ""})
    EXPECT_EQ(get(at("/"), {kHost}, {}, method).status, 405) << method;
}

TEST_F(ViewRouterTest, RefusesLongTargets) {
  const std::string longest = at("/query?x=" + std::string(2000, '1'));
  EXPECT_EQ(get(longest).status, 414);
  EXPECT_EQ(get(longest.substr(0, ViewRouter::kMaxTargetBytes)).status, 400);
}

TEST_F(ViewRouterTest, RefusesBadQueries) {
  for (const char* rest :
       {"/shape", "/shape?", "/shape?discs=0", "/shape?discs=1.5", "/shape?discs=200001",
        "/shape?discs=1&discs=2", "/shape?discs=1&x=1", "/shape?discs=1&", "/shape?discs=+1",
        "/shape?discs=1&x=1&y=2&z=3&dx=0&dy=0&dz=0&cosine=0.5",
        "/shape?discs=1&x=1&y=2&z=3&dx=0&dy=0&dz=1&cosine=1.5", "/query?x=1&y=2&z=3",
        "/query?x=1&y=2&z=nan&within=0", "/query?x=1&y=2&z=1e999&within=0",
        "/query?x=1&y=2&z=3&within=-1", "/query?x=1&y=2&z=%33&within=0",
        "/query?x=1&y=2&z=3&within=1&w=1", "/view.js?x=1", "/?"})
    EXPECT_EQ(get(at(rest)).status, 400) << rest;
  EXPECT_EQ(get(at("/info?x=1")).status, 404);
}

TEST_F(ViewRouterTest, SaysWhatCannotBeRead) {
  const ViewReply reply = get(at("/shape?discs=13"));
  EXPECT_EQ(reply.status, 500);
  EXPECT_EQ(reply.body, "it cannot be read\n");
}

TEST(ViewRouterHeaders, ForbidThePageToGoElsewhere) {
  std::set<std::string> names;
  for (const ViewHeader& header : ViewRouter::headers()) {
    names.insert(header.name);
    if (std::string(header.name) == "Content-Security-Policy") {
      const std::string policy = header.value;
      EXPECT_EQ(policy.rfind("default-src 'none';", 0), 0u);
      EXPECT_EQ(policy.find("unsafe"), std::string::npos);
      EXPECT_EQ(policy.find("http"), std::string::npos);
    }
  }
  for (const char* name : {"Content-Security-Policy", "X-Content-Type-Options", "Referrer-Policy",
                           "Cache-Control", "Cross-Origin-Resource-Policy"})
    EXPECT_EQ(names.count(name), 1u) << name;
}

}  // namespace
}  // namespace planetree::tools
