// Prints digests of answers and of built files, to compare compilers and processors.
// usage: check_bits [COUNT] [--target NAME]
//        check_bits --compare COUNT
// COUNT queries are distributed over the models; default: a million. NAME is an instruction set as
// Highway calls it. --compare runs this program once for every instruction set available and once
// with a libm for old processors; exit status 1 if the digests differ.

#include <hwy/highway.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/oracle/closed_models.h"
#include "tests/oracle/random_queries.h"
#include "tests/query/answer_bits.h"
#include "tests/storage/system/temporary_directory.h"
#include "tools/cli/file_digest.h"

namespace planetree::oracle {
namespace {

constexpr const char* kOldLibm =
    "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX512DQ,-AVX2,-AVX,-FMA,-FMA4,-SSE4_1,"
    "-SSE4_2,-SSSE3";

[[noreturn]] void give_up(const std::string& why) {
  std::fprintf(stderr, "check_bits: %s\n", why.c_str());
  std::exit(2);
}

void use_only(std::string_view name) {
  for (std::int64_t targets = hwy::SupportedTargets() & HWY_TARGETS; targets != 0;
       targets &= targets - 1) {
    const std::int64_t target = targets & -targets;
    if (hwy::TargetName(target) != name) continue;
    hwy::SetSupportedTargetsForTest(target);
    return;
  }
  give_up("no instruction set " + std::string(name) + " here");
}

// The answers and the built files to digest, collected in two files.
class Collection {
 public:
  Collection() : answers_(folder_ / "answers"), files_(folder_ / "files") {}

  void add_file(const std::filesystem::path& path) {
    const std::ifstream file(path, std::ios::binary);
    files_ << file.rdbuf();
  }
  void add(const Containment& answer) {
    answers_.put(static_cast<char>(answer.side)).put(static_cast<char>(answer.status));
  }
  void add(const ClosestPoint& answer) {
    const AnswerBits bits = bits_of(answer);
    answers_.write(reinterpret_cast<const char*>(bits.data()), sizeof bits);
  }
  void print() {
    answers_.close();
    files_.close();
    for (const char* name : {"answers", "files"}) {
      const auto digest = tools::sha256_of_file(folder_ / name);
      if (!answers_ || !files_ || !digest) give_up("the digest cannot be computed");
      std::printf("%s %s\n", digest->c_str(), name);
    }
  }

 private:
  storage::TemporaryDirectory folder_;
  std::ofstream answers_, files_;
};

void collect(std::size_t queries, Collection& collection) {
  const std::size_t share = (queries + kQueriedModels + 1) / (kQueriedModels + 2);
  for (std::size_t number = 0; number < kQueriedModels; ++number) {
    QueriedModel model(number);
    collection.add_file(model.built.path());
    for (std::size_t i = 0; i < share; ++i) {
      const Vec3 query = model.query();
      collection.add(model.built.closest_point(query));
      collection.add(model.built.probe().contains(query));
    }
  }
  // Trees of many levels: of a closed surface, and of one with holes.
  constexpr std::size_t kApart = 100;
  Soup closed = ball(6), open;
  for (std::size_t i = 0; i < closed.size(); ++i)
    if (i % kApart != 0) open.push_back(closed[i]);
  for (const Soup& soup : {closed, open}) {
    BuiltModel large(soup, {4096, 1 << 22, 1});
    collection.add_file(large.path());
    Random random(7);
    for (std::size_t i = 0; i < share; ++i) {
      const Vec3 query = random.in_cube() * 1.5;
      collection.add(large.closest_point(query));
      collection.add(large.probe().contains(query));
    }
  }
}

std::string output_of(const std::string& command) {
  std::FILE* pipe = ::popen(command.c_str(), "r");
  if (!pipe) give_up("cannot start " + command);
  std::string text;
  std::array<char, 256> piece{};
  while (std::fgets(piece.data(), piece.size(), pipe)) text += piece.data();
  if (::pclose(pipe) != 0 || text.empty()) give_up(command + " failed");
  return text;
}

int compare(const std::string& program, const std::string& queries) {
  std::vector<std::string> commands{"'" + program + "' " + queries};
  commands.push_back(std::string("env ") + kOldLibm + " " + commands[0]);
  for (std::int64_t targets = hwy::SupportedTargets() & HWY_TARGETS; targets != 0;
       targets &= targets - 1)
    commands.push_back(commands[0] + " --target " + hwy::TargetName(targets & -targets));
  const std::string expected = output_of(commands[0]);
  std::printf("%s", expected.c_str());
  bool alike = true;
  for (const std::string& command : commands) {
    const bool same = output_of(command) == expected;
    std::printf("%s: %s\n", same ? "the same" : "NOT THE SAME", command.c_str());
    alike = alike && same;
  }
  return alike ? 0 : 1;
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() == 3 && arguments[1] == "--compare")
    return compare(arguments[0], arguments[2]);
  const bool named = arguments.size() > 2 && arguments[arguments.size() - 2] == "--target";
  if (arguments.size() > (named ? 4 : 2)) give_up("usage: check_bits [COUNT] [--target NAME]");
  if (named) use_only(arguments.back());
  const bool counted = arguments.size() == (named ? 4 : 2);
  const std::size_t queries = counted ? std::strtoull(arguments[1].c_str(), nullptr, 10) : 1000000;
  if (queries == 0) give_up("COUNT is a number");
  Collection collection;
  collect(queries, collection);
  collection.print();
  return 0;
}

}  // namespace
}  // namespace planetree::oracle

int main(int count, char** arguments) {
  return planetree::oracle::run({arguments, arguments + count});
}
