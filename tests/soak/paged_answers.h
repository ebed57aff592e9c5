#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "planetree/error.h"
#include "planetree/types.h"
#include "tests/query/answer_bits.h"

/// ClosestPointQuery with much memory, and with little in a process of its own, so that
/// its memory can be measured. For check_real: what fails ends the program.
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

/// One answer per query, by one probe.
std::vector<ClosestPoint> answers_of(const std::filesystem::path& tree, std::uint64_t budget_bytes,
                                     const std::vector<Vec3>& queries);

struct PagedAnswers {
  std::vector<AnswerBits> answers;
  std::uint64_t peak_resident_bytes = 0;  ///< of the process that asked
};

/// Starts this program again to ask within kSmallBudgetBytes. `folder` takes
/// what the two tell each other.
PagedAnswers query_in_new_process(const std::filesystem::path& tree,
                                  const std::filesystem::path& folder,
                                  const std::vector<Vec3>& queries);

/// What the program started so does: its arguments, from the first on, are
/// "--ask" and two paths.
bool is_new_process(int count, char** arguments);
int run_new_process(char** arguments);

}  // namespace planetree::oracle
