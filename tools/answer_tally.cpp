#include "tools/answer_tally.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/cli/size_text.h"

namespace planetree::tools {
namespace {

double rate_of(std::uint64_t queries, double seconds) {
  return static_cast<double>(queries) / std::max(seconds, 1e-9);
}

}  // namespace

nlohmann::ordered_json AnswerTally::json(double seconds) const {
  nlohmann::ordered_json report = {{noun(), queries_}};
  for (std::size_t i = 0; i < kStatusCount; ++i)
    report[std::string(status_word(static_cast<Status>(i)))] = by_status_[i];
  if (shape_.kind == RowKind::kPoint) {
    for (std::size_t i = 0; i < kSideCount; ++i)
      report["sides"][std::string(side_word(static_cast<Side>(i)))] = by_side_[i];
  } else {
    report["hits"] = hits_;
    report["free"] = free_;
  }
  report["seconds"] = seconds;
  report[noun() + "_per_second"] = rate_of(queries_, seconds);
  return report;
}

std::string AnswerTally::text(double seconds) const {
  std::string line = fmt::format("{} {}{} in {:.1f} s ({} {}s/s)", grouped_count(queries_),
                                 shape_.noun, queries_ == 1 ? "" : "s", seconds,
                                 short_count(rate_of(queries_, seconds)), shape_.noun);
  const char* before = ": ";
  for (std::size_t i = 0; i < kStatusCount; ++i) {
    if (by_status_[i] == 0) continue;
    line += fmt::format("{}{} {}", before, grouped_count(by_status_[i]),
                        status_word(static_cast<Status>(i)));
    before = ", ";
  }
  return line;
}

}  // namespace planetree::tools
