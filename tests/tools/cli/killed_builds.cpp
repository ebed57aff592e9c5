#include "tests/tools/cli/killed_builds.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>
#include <vector>

namespace planetree::tools {
namespace {

namespace fs = std::filesystem;

// Starts the program, silent except for errors.
pid_t spawn(const fs::path& program, const std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  std::vector<std::string> all = arguments;
  all.insert(all.begin(), program.string());
  for (std::string& argument : all) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const pid_t child = ::fork();
  if (child != 0) return child;
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  ::dup2(nowhere, STDOUT_FILENO);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

int status_of(pid_t child) {
  int status = 0;
  return ::waitpid(child, &status, 0) == child ? status : -1;
}

}  // namespace

KilledBuilds::KilledBuilds(fs::path command, unsigned seed)
    : command_(std::move(command)), random_(seed) {}

std::string KilledBuilds::prepare(const std::string& triangles, const std::string& holes) {
  if (status_of(spawn(command_, {"generate", (models_ / "model.ply").string(), "--triangles",
                                 triangles, "--holes", holes, "--quiet"})) != 0)
    return "the model cannot be generated";
  for (const bool resume : {false, true}) {
    const auto started = std::chrono::steady_clock::now();
    if (status_of(start(false, resume)) != 0) return "the model cannot be built";
    build_times_[resume ? 1 : 0] = std::chrono::steady_clock::now() - started;
    const storage::Bytes built = storage::read_bytes(output_);
    if (resume && built != complete_) return "--resume builds another file";
    complete_ = built;
    fs::remove(output_);
  }
  return {};
}

bool KilledBuilds::has_unnamed_files() const {
  for (const auto* folder : {&output_folder_, &spill_folder_}) {
    const int file = ::open((*folder / ".").c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (file < 0) return false;
    ::close(file);
  }
  return true;
}

int KilledBuilds::start(bool replace, bool resume) const {
  std::vector<std::string> arguments = {"build",    (models_ / "model.ply").string(),
                                        "-o",       output_.string(),
                                        "--memory", "160M",
                                        "--quiet",  "--temp-dir"};
  arguments.push_back((spill_folder_ / ".").string());
  if (replace) arguments.emplace_back("--force");
  if (resume) arguments.emplace_back("--resume");
  return spawn(command_, arguments);
}

KilledBuilds::Left KilledBuilds::kill_one(unsigned which, unsigned parts, bool resume) {
  const bool replace = which % 2 == 0;
  fs::remove(output_);
  if (replace) storage::write_bytes(output_, old_);
  const double moment = std::uniform_real_distribution<double>(which, which + 1)(random_) / parts;
  const pid_t child = start(replace, resume);
  std::this_thread::sleep_for(moment * build_times_[resume ? 1 : 0]);
  ::kill(child, SIGKILL);
  const int status = status_of(child);
  const bool killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
  Left left = look(replace, resume && killed);
  left.killed = killed;
  if (resume && killed) left.wrong += go_on();
  if (!left.killed && status != 0) left.wrong += "; the build failed";
  if (!left.killed && !left.complete) left.wrong += "; the build was done, but not the file";
  if (!left.wrong.empty())
    left.wrong = "killed after " + std::to_string(moment) + " of its time" + left.wrong;
  return left;
}

KilledBuilds::Left KilledBuilds::look(bool replace, bool resume) const {
  Left left;
  const bool there = fs::exists(fs::symlink_status(output_));
  const storage::Bytes found = there ? storage::read_bytes(output_) : storage::Bytes();
  left.complete = there && found == complete_;
  if (!left.complete && (there != replace || (there && found != old_)))
    left.wrong += "; the destination is neither as before nor whole";
  for (const std::string& name : output_folder_.names()) {
    if (name == output_.filename()) continue;
    const fs::path path = output_folder_ / name.c_str();
    left.temporary_name = replace && !left.complete && storage::read_bytes(path) == complete_;
    if (!left.temporary_name) left.wrong += "; " + name + " is left beside the destination";
    fs::remove(path);
  }
  for (const std::string& name : spill_folder_.names()) {
    left.work = resume && name.ends_with(".work");
    if (left.work) continue;
    left.wrong += "; " + name + " is left of the temporary files";
    fs::remove(spill_folder_ / name.c_str());
  }
  return left;
}

// Resumes the build; returns what went wrong, empty if nothing. The output may exist already.
std::string KilledBuilds::go_on() const {
  std::string wrong;
  if (status_of(start(fs::exists(output_), true)) != 0)
    wrong += "; it cannot be gone on with";
  else if (storage::read_bytes(output_) != complete_)
    wrong += "; gone on with it is another file";
  if (output_folder_.names().size() > 1) wrong += "; more than the file is left then";
  for (const std::string& name : spill_folder_.names()) {
    wrong += "; " + name + " is left then";
    fs::remove_all(spill_folder_ / name.c_str());
  }
  return wrong;
}

}  // namespace planetree::tools
