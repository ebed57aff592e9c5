#include "tests/soak/paged_answers.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <string>

#include "planetree/planetree.h"

namespace planetree::oracle {
namespace {

namespace fs = std::filesystem;

constexpr const char* kQuery = "--query";

struct Messages {
  explicit Messages(const fs::path& folder)
      : queries(folder / "queries"), answers(folder / "answers"), resident(folder / "resident") {}
  fs::path queries, answers, resident;
};

template <class T>
void save(const fs::path& path, const std::vector<T>& values) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(T)));
  if (!file) give_up(path.c_str(), "cannot be written");
}

template <class T>
std::vector<T> load(const fs::path& path) {
  std::vector<T> values(fs::file_size(path) / sizeof(T));
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(T)));
  if (!file) give_up(path.c_str(), "cannot be read");
  return values;
}

// Peak resident memory since this program was started. Not from getrusage(), which includes the
// memory of the process that started it.
std::uint64_t peak_resident_bytes() {
  std::ifstream file("/proc/self/status");
  std::string word;
  while (file >> word) {
    if (word != "VmHWM:") continue;
    std::uint64_t kibibytes = 0;
    file >> kibibytes;
    return kibibytes * 1024;
  }
  give_up("/proc/self/status", "has no VmHWM");
}

}  // namespace

std::vector<ClosestPoint> answers_of(const fs::path& tree, std::uint64_t budget_bytes,
                                     const std::vector<Vec3>& queries) {
  OpenOptions options;
  options.memory_budget_bytes = budget_bytes;
  options.max_probes = 1;
  const Model model = need(Model::open(tree, options), "open");
  Probe probe = need(Probe::create(model), "probe");
  std::vector<ClosestPoint> answers(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) answers[i] = probe.closest_point(queries[i]);
  return answers;
}

PagedAnswers query_in_new_process(const fs::path& tree, const fs::path& folder,
                                  const std::vector<Vec3>& queries) {
  const Messages messages(folder);
  save(messages.queries, queries);
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl("/proc/self/exe", "check_real", kQuery, tree.c_str(), folder.c_str(), nullptr);
    std::_Exit(127);
  }
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child || status != 0)
    give_up("queries within a small budget", "failed");
  return {load<AnswerBits>(messages.answers), load<std::uint64_t>(messages.resident).at(0)};
}

bool is_new_process(int count, char** arguments) {
  return count == 4 && std::strcmp(arguments[1], kQuery) == 0;
}

int run_new_process(char** arguments) {
  const Messages messages(arguments[3]);
  std::vector<AnswerBits> answers;
  for (const ClosestPoint& answer :
       answers_of(arguments[2], kSmallBudgetBytes, load<Vec3>(messages.queries)))
    answers.push_back(bits_of(answer));
  save(messages.answers, answers);
  save(messages.resident, std::vector{peak_resident_bytes()});
  return 0;
}

}  // namespace planetree::oracle
