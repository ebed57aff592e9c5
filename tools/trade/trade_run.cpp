#include "tools/trade/trade_run.h"

#include <cmath>
#include <ctime>
#include <utility>

#include "tools/session/sorted.h"

namespace planetree::tools {
namespace {

TradeQuantiles quantiles_of(std::vector<double> values) {
  const Sorted<double> sorted(std::move(values));
  return {sorted.at(0.5), sorted.at(0.99), sorted.at(1)};
}

bool is_broken(const ClosestPoint& answer, const ClosestPoint& exact) {
  return answer.lower > exact.upper || answer.upper < exact.lower;
}

}  // namespace

double thread_seconds() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

TradeResult compare_answers(std::span<const ClosestPoint> answers,
                            std::span<const ClosestPoint> exact) {
  TradeResult result;
  result.points = answers.size();
  std::vector<double> promised, actual;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const ClosestPoint& answer = answers[i];
    promised.push_back(answer.upper - answer.lower);
    actual.push_back(std::fabs(answer.distance - exact[i].distance));
    result.broken += is_broken(answer, exact[i]);
    result.exact += answer.status == Status::kExact;
    result.degraded += answer.status == Status::kDegraded;
    result.side_unknown += answer.side == Side::kUnknown;
    result.side_wrong += answer.side != Side::kUnknown && exact[i].side != Side::kUnknown &&
                         answer.side != exact[i].side;
  }
  result.promised = quantiles_of(std::move(promised));
  result.actual = quantiles_of(std::move(actual));
  return result;
}

std::vector<double> median_seconds(std::span<const std::function<void()>> actions, int rounds) {
  std::vector<std::vector<double>> seconds(actions.size());
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < actions.size(); ++i) {
      const double before = thread_seconds();
      actions[i]();
      seconds[i].push_back(thread_seconds() - before);
    }
  std::vector<double> medians;
  for (auto& times : seconds) medians.push_back(Sorted<double>(std::move(times)).at(0.5));
  return medians;
}

}  // namespace planetree::tools
