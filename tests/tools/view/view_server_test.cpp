#include "tools/view/view_server.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "tests/tools/view/raw_client.h"
#include "tests/tools/view/sample_source.h"
#include "tools/view/serving_threads.h"

namespace planetree::tools {
namespace {

class ViewServerTest : public testing::Test {
 protected:
  void SetUp() override {
    auto server = ViewServer::start({}, kSampleFiles, source_);
    ASSERT_TRUE(server) << server.error().text;
    server_ = std::move(*server);
    const std::string page = server_->pages().at(0), host = "127.0.0.1:" + port();
    ASSERT_EQ(page.substr(0, 7 + host.size()), "http://" + host);
    path_ = page.substr(7 + host.size());
  }
  std::string port() const { return std::to_string(server_->port()); }
  /// The head of a request for something of the page.
  std::string head(const std::string& name, const std::string& method = "GET") const {
    return method + " " + path_ + name + " HTTP/1.1\r\nHost: 127.0.0.1:" + port() + "\r\n";
  }
  std::string ask(const std::string& request) const {
    return answer_from(server_->port(), request);
  }
  void expect_answers() const {
    const std::string answer = ask(head("info") + "\r\n");
    EXPECT_EQ(status_of(answer), 200);
    EXPECT_TRUE(answer.ends_with("\r\n\r\ninfo")) << answer;
  }

  SampleSource source_;
  std::unique_ptr<ViewServer> server_;
  std::string path_;  // with the token
};

TEST_F(ViewServerTest, AnswersWithItsHeaders) {
  const std::string answer = ask(head("view.js") + "\r\n");
  EXPECT_EQ(status_of(answer), 200);
  for (const ViewHeader& header : ViewRouter::headers())
    EXPECT_NE(answer.find(std::string(header.name) + ": " + header.value), std::string::npos);
  EXPECT_NE(answer.find("Content-Type: text/javascript"), std::string::npos);
  EXPECT_TRUE(answer.ends_with("\r\n\r\nmain()"));
}

TEST_F(ViewServerTest, HasATokenOfItsOwn) {
  auto other = ViewServer::start({}, kSampleFiles, source_);
  ASSERT_TRUE(other);
  const std::string page = (*other)->pages().at(0);
  EXPECT_NE(page.substr(page.size() - path_.size()), path_);
  EXPECT_EQ(path_.size(), ViewRouter::kTokenBytes + 2);
}

TEST_F(ViewServerTest, RefusesForeignRequests) {
  const std::string host = "Host: 127.0.0.1:" + port() + "\r\n";
  EXPECT_EQ(status_of(ask("GET / HTTP/1.1\r\n" + host + "\r\n")), 404);
  EXPECT_EQ(status_of(ask("GET " + path_ + " HTTP/1.1\r\nHost: evil.example\r\n\r\n")), 403);
  EXPECT_EQ(status_of(ask("GET " + path_ + " HTTP/1.0\r\n\r\n")), 403);
  EXPECT_EQ(status_of(ask(head("") + host + "\r\n")), 403) << "two hosts";
  EXPECT_EQ(status_of(ask(head("") + "Origin: http://evil.example\r\n\r\n")), 403);
  EXPECT_EQ(status_of(ask(head("", "POST") + "Content-Length: 4\r\n\r\nabcd")), 405);
  EXPECT_EQ(status_of(ask(head("", "DELETE") + "\r\n")), 405);
  EXPECT_EQ(status_of(ask("GET /../../etc/passwd HTTP/1.1\r\n" + host + "\r\n")), 404);
  expect_answers();
}

TEST_F(ViewServerTest, GivesTheWholeOfAnAnswerWhateverRangesAreAskedFor) {
  std::string ranges = "Range: bytes=0-";
  for (int i = 0; i < 500; ++i) ranges += ",0-";
  const std::string answer = ask(head("view.js") + ranges + "\r\n\r\n");
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_TRUE(answer.ends_with("\r\n\r\nmain()"));
}

TEST_F(ViewServerTest, RefusesWhatIsNoRequest) {
  const std::string requests[] = {"\r\n\r\n", "GET\r\n\r\n", "BREW / HTTP/1.1\r\n\r\n",
                                  std::string(4096, '\0') + "\r\n\r\n"};
  for (const std::string& request : requests) {
    const int status = status_of(ask(request));
    EXPECT_TRUE(status == 0 || (status >= 400 && status < 500)) << status;
  }
  expect_answers();
}

TEST_F(ViewServerTest, RefusesLongRequests) {
  EXPECT_EQ(status_of(ask(head("query?x=" + std::string(3000, '1')) + "\r\n")), 414);
  EXPECT_EQ(status_of(ask("GET " + path_ + std::string(20000, 'x') + " HTTP/1.1\r\n\r\n")), 414);
  const auto refused = [](int status) { return status == 0 || status >= 400; };
  EXPECT_TRUE(refused(status_of(ask(head("info") + "X: " + std::string(9000, 'x') + "\r\n\r\n"))));
  std::string many = head("info");
  for (int i = 0; i < 10000; ++i) many += "X-Header-" + std::to_string(i) + ": 1\r\n";
  EXPECT_TRUE(refused(status_of(ask(many + "\r\n"))));
  expect_answers();
}

TEST_F(ViewServerTest, AnswersBesideManyThatAskNothing) {
  std::vector<RawClient> idle;
  for (std::size_t i = 0; i < 10 * ServingThreads::kThreads; ++i) {
    idle.emplace_back(server_->port());
    ASSERT_TRUE(idle.back().is_open());
    if (i % 2 == 0) idle.back().send("GET / HT");
  }
  expect_answers();
}

TEST_F(ViewServerTest, EndsBesideThoseThatAskNothing) {
  std::vector<RawClient> idle;
  for (std::size_t i = 0; i < 3 * ServingThreads::kThreads; ++i) idle.emplace_back(server_->port());
  expect_answers();
  const std::uint16_t port = server_->port();
  server_.reset();
  EXPECT_FALSE(RawClient(port).is_open());
}

TEST_F(ViewServerTest, DoesNotShareItsPort) {
  ViewPlace place;
  place.port = server_->port();
  const auto other = ViewServer::start(place, kSampleFiles, source_);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, ErrorCode::kPermission);
  expect_answers();
}

TEST_F(ViewServerTest, ListensAtSeveralAddresses) {
  ViewPlace place;
  place.addresses = {"127.0.0.1", "127.0.0.2"};
  const auto server = ViewServer::start(place, kSampleFiles, source_);
  ASSERT_TRUE(server) << server.error().text;
  ASSERT_EQ((*server)->pages().size(), 2u);
  EXPECT_NE((*server)->pages()[1].find("http://127.0.0.2:"), std::string::npos);
}

}  // namespace
}  // namespace planetree::tools
