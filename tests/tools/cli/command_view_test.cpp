// `planetree view` as a process: its address, its end by a signal, and its errors.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"
#include "tests/tools/view/raw_client.h"

namespace planetree::tools {
namespace {

/// The command in a process of its own, and the first line of its output.
class Session {
 public:
  explicit Session(std::vector<std::string> arguments) {
    int ends[2];
    if (::pipe(ends) != 0) return;
    process_ = ::fork();
    if (process_ == 0) {
      ::dup2(ends[1], STDOUT_FILENO);
      std::vector<char*> words = {const_cast<char*>("planetree"), const_cast<char*>("view")};
      for (std::string& argument : arguments) words.push_back(argument.data());
      words.push_back(nullptr);
      ::execv(PLANETREE_COMMAND, words.data());
      ::_exit(127);
    }
    ::close(ends[1]);
    for (char byte = 0; ::read(ends[0], &byte, 1) == 1 && byte != '\n';) line_ += byte;
    ::close(ends[0]);
  }
  ~Session() {
    if (process_ > 0) end(SIGKILL);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  const std::string& line() const { return line_; }
  /// Sends a signal and returns the exit status, or -1 if the process did not exit by itself.
  int end(int signal) {
    ::kill(process_, signal);
    int status = 0;
    ::waitpid(std::exchange(process_, -1), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t process_ = -1;
  std::string line_;
};

using CommandView = Command;

TEST_F(CommandView, ServesThePageUntilItGetsASignal) {
  for (const int signal : {SIGINT, SIGTERM}) {
    Session session({"tree.ptree", "--no-open", "--json"});
    const Json report = Json::parse(session.line());
    EXPECT_EQ(report["file"], "tree.ptree");
    const std::uint16_t port = report["port"];
    const std::string page = report["pages"].at(0), start = "http://127.0.0.1:";
    ASSERT_EQ(page.substr(0, start.size()), start);
    const std::string path = page.substr(page.find('/', start.size()));
    const std::string tail = " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n\r\n";
    const std::string html = answer_from(port, "GET " + path + tail);
    EXPECT_EQ(status_of(html), 200);
    EXPECT_NE(html.find("<!doctype html>"), std::string::npos);
    const std::string info = answer_from(port, "GET " + path + "info" + tail);
    EXPECT_EQ(Json::parse(info.substr(info.find("\r\n\r\n")))["triangles"], kTriangles);
    EXPECT_EQ(status_of(answer_from(port, "GET /" + tail)), 404);
    EXPECT_EQ(session.end(signal), 0);
  }
}

TEST_F(CommandView, PrintsTheAddressAlone) {
  Session session({"tree.ptree", "--no-open", "--quiet"});
  EXPECT_EQ(session.line().substr(0, 17), "http://127.0.0.1:");
  EXPECT_EQ(session.end(SIGTERM), 0);
}

TEST_F(CommandView, RefusesWhatItCannotShow) {
  write("text.ptree", "text");
  EXPECT_EQ(run({"view", "text.ptree", "--no-open"}).status, kDataAtFault);
  EXPECT_EQ(run({"view", "none.ptree", "--no-open"}).status, kCommandLineAtFault);
  EXPECT_EQ(run({"view", "tree.ptree", "--no-open", "--trace", "mesh.obj"}).status, kDataAtFault);
  EXPECT_EQ(run({"view", "tree.ptree", "--memory", "1K"}).status, kMachineAtFault);
}

TEST_F(CommandView, ShowsAScene) {
  write("scene.json", R"({"format": "planetree-scene", "version": 1, "memory": "16M",
    "models": {"mesh": {"file": "tree.ptree"}},
    "instances": [{"name": "left", "model": "mesh"},
                  {"model": "mesh", "translation": [50, 0, 0]}]})");
  for (const std::string memory : {"16M", "24M"}) {
    Session session({"scene.json", "--no-open", "--json", "--memory", memory});
    const Json report = Json::parse(session.line());
    EXPECT_EQ(report["file"], "scene.json");
    const std::uint16_t port = report["port"];
    const std::string page = report["pages"].at(0);
    const std::string path = page.substr(page.find('/', 7));
    const std::string info = answer_from(port, "GET " + path + "info HTTP/1.1\r\nHost: 127.0.0.1:" +
                                                   std::to_string(port) + "\r\n\r\n");
    const Json facts = Json::parse(info.substr(info.find("\r\n\r\n")));
    EXPECT_EQ(facts["instances"][0]["name"], "left");
    EXPECT_EQ(facts["triangles"], 2 * kTriangles);
    EXPECT_EQ(facts["memory_bytes"], (memory == "16M" ? 16 : 24) << 20);
    EXPECT_EQ(session.end(SIGTERM), 0);
  }
  const Outcome traced = run({"view", "scene.json", "--no-open", "--trace", "mesh.obj"});
  EXPECT_EQ(traced.status, kCommandLineAtFault);
  EXPECT_NE(traced.errors.find("leave --trace out"), std::string::npos) << traced.errors;
}

TEST_F(CommandView, SaysWhichFilesOfASceneAreAtFault) {
  write("scene.json", R"({"format": "planetree-scene", "version": 1,
    "models": {"mesh": {"file": "none.ptree"}}, "instances": [{"model": "mesh"}]})");
  const Outcome outcome = run({"view", "scene.json", "--no-open"});
  EXPECT_EQ(outcome.status, kCommandLineAtFault);
  EXPECT_NE(outcome.errors.find("none.ptree"), std::string::npos) << outcome.errors;
  write("empty.json", "{}");
  EXPECT_EQ(run({"view", "empty.json", "--no-open"}).status, kDataAtFault);
  const Outcome neither = run({"view", "mesh.obj", "--no-open"});
  EXPECT_EQ(neither.status, kDataAtFault);
  EXPECT_NE(neither.errors.find("neither a .ptree file nor a scene file"), std::string::npos);
}

TEST_F(CommandView, RefusesBadAddresses) {
  for (const char* address : {"localhost", "127.0.0.1:80", "", "[::1]"}) {
    const Outcome outcome = run({"view", "tree.ptree", "--listen", address});
    EXPECT_EQ(outcome.status, kCommandLineAtFault) << address;
  }
  EXPECT_EQ(run({"view", "tree.ptree", "--port", "65536"}).status, kCommandLineAtFault);
  EXPECT_EQ(run({"view", "tree.ptree", "--no-open", "--listen", "192.0.2.1"}).status,
            kMachineAtFault);
}

TEST_F(CommandView, RefusesTheTraceOfAnotherModel) {
  write_mesh("other.obj", 5);
  build_sample("other.obj", "other.ptree");
  ASSERT_EQ(
      run({"touch", "other.ptree", "--seconds", "1", "--deterministic", "--trace", "other.trace"})
          .status,
      kDone);
  const Outcome outcome = run({"view", "tree.ptree", "--no-open", "--trace", "other.trace"});
  EXPECT_EQ(outcome.status, kCommandLineAtFault);
  EXPECT_NE(outcome.errors.find("another model"), std::string::npos) << outcome.errors;
}

}  // namespace
}  // namespace planetree::tools
