#include "tools/answer_tally.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/cli/size_text.h"

namespace planetree::tools {
namespace {

double rate_of(std::uint64_t points, double seconds) {
  return static_cast<double>(points) / std::max(seconds, 1e-9);
}

}  // namespace

nlohmann::ordered_json AnswerTally::json(double seconds) const {
  nlohmann::ordered_json report = {{"points", points}};
  for (std::size_t i = 0; i < kStatusCount; ++i)
    report[std::string(status_word(static_cast<Status>(i)))] = by_status[i];
  for (std::size_t i = 0; i < kSideCount; ++i)
    report["sides"][std::string(side_word(static_cast<Side>(i)))] = by_side[i];
  report["seconds"] = seconds;
  report["points_per_second"] = rate_of(points, seconds);
  return report;
}

std::string AnswerTally::text(double seconds) const {
  std::string line =
      fmt::format("{} point{} in {:.1f} s ({} points/s)", grouped_count(points),
                  points == 1 ? "" : "s", seconds, short_count(rate_of(points, seconds)));
  const char* before = ": ";
  for (std::size_t i = 0; i < kStatusCount; ++i) {
    if (by_status[i] == 0) continue;
    line += fmt::format("{}{} {}", before, grouped_count(by_status[i]),
                        status_word(static_cast<Status>(i)));
    before = ", ";
  }
  return line;
}

}  // namespace planetree::tools
