#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "planetree/error.h"
#include "planetree/types.h"
#include "tests/query/answer_bits.h"

/// Answers with much memory, and with little memory in a process of its own, so that the memory can
/// be measured. For check_real; a failure ends the program.
namespace planetree::oracle {

inline constexpr std::uint64_t kSmallBudgetBytes = std::uint64_t{32} << 20;

[[noreturn]] inline void give_up(const char* what, const char* why) {
  std::fprintf(stderr, "check_real: %s: %s\n", what, why);
  std::exit(1);
}

template <class T>
T need(Result<T> result, const char* what) {
  if (!result) give_up(what, result.error().text);
  return std::move(*result);
}

/// Returns one answer for each query, by one probe.
std::vector<ClosestPoint> answers_of(const std::filesystem::path& tree, std::uint64_t budget_bytes,
                                     const std::vector<Vec3>& queries);

struct PagedAnswers {
  std::vector<AnswerBits> answers;
  std::uint64_t peak_resident_bytes = 0;  ///< of the process that queried
};

/// Starts this program again to query within kSmallBudgetBytes. The two processes exchange files in
/// `folder`.
PagedAnswers query_in_new_process(const std::filesystem::path& tree,
                                  const std::filesystem::path& folder,
                                  const std::vector<Vec3>& queries);

/// Entry point of the process started this way: its arguments are "--query" and two paths.
bool is_new_process(int count, char** arguments);
int run_new_process(char** arguments);

}  // namespace planetree::oracle
