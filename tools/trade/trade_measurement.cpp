#include "tools/trade/trade_measurement.h"

#include <algorithm>
#include <chrono>
#include <span>
#include <thread>
#include <utility>

namespace planetree::tools {
namespace {

constexpr int kRounds = 3;
/// Queries that do not wait come at the rate of a haptic device, and not more than so many.
constexpr std::chrono::milliseconds kPace(1);
constexpr std::size_t kMaxPaced = 1000;

QueryOptions options_of(const TradeSetting& setting, std::uint32_t parts) {
  QueryOptions options;
  options.parts = parts;
  options.max_error = setting.max_error;
  options.max_work = setting.max_work;
  options.wait = setting.wait;
  return options;
}

void answer_all(Probe& probe, std::span<const Vec3> points, const QueryOptions& options,
                std::vector<ClosestPoint>& answers) {
  answers.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    answers[i] = probe.closest_point(points[i], options);
}

/// Answers points one each kPace. Returns the processor time of the queries.
double answer_paced(Probe& probe, std::span<const Vec3> points, const QueryOptions& options,
                    std::vector<ClosestPoint>& answers) {
  answers.resize(points.size());
  double seconds = 0;
  auto due = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::this_thread::sleep_until(due);
    const double before = thread_seconds();
    answers[i] = probe.closest_point(points[i], options);
    seconds += thread_seconds() - before;
    due += kPace;
  }
  return seconds;
}

}  // namespace

OpenOptions trade_open_options(std::uint64_t memory_bytes, std::uint32_t layers) {
  OpenOptions options;
  options.memory_budget_bytes = memory_bytes;
  options.max_probes = 1;
  options.layers = layers;
  return options;
}

void TradeMeasurement::add(TradeWorkload workload, std::vector<Vec3> points, Probe& probe) {
  record_.workloads.push_back(workload);
  Points& added = workloads_.emplace_back();
  added.points = std::move(points);
  answer_all(probe, added.points, {.parts = record_.parts}, added.exact);
}

Result<void> TradeMeasurement::measure(const TradeSetting& setting) {
  TradeRow row{setting, {}};
  const bool paced = setting.wait == Wait::kNever;
  for (const Points& workload : workloads_) {
    const auto model = Model::open(file_, trade_open_options(setting.memory_bytes, record_.layers));
    if (!model && paced && model.error().code == ErrorCode::kNoMemory) {
      record_.too_small.push_back(setting.memory_bytes);
      return {};
    }
    if (!model) return model.error();
    auto probe = Probe::create(*model);
    if (!probe) return probe.error();
    const auto points =
        std::span(workload.points)
            .first(std::min(workload.points.size(), paced ? kMaxPaced : workload.points.size()));
    std::vector<ClosestPoint> answers;
    double seconds = 0;
    if (paced)
      seconds = answer_paced(*probe, points, options_of(setting, record_.parts), answers);
    else
      answer_all(*probe, points, options_of(setting, record_.parts), answers);
    row.results.push_back(compare_answers(answers, std::span(workload.exact).first(points.size())));
    row.results.back().seconds = seconds;
    row.results.back().pages = model->stats().pages_read;
    done_();
  }
  record_.rows.push_back(std::move(row));
  return {};
}

void TradeMeasurement::measure_times(const Model& model) {
  for (std::size_t i = 0; i < workloads_.size(); ++i) measure_times(model, i);
}

void TradeMeasurement::measure_times(const Model& model, std::size_t workload) {
  const std::vector<Vec3>& points = workloads_[workload].points;
  std::vector<std::function<void()>> actions;
  std::vector<ClosestPoint> answers;
  for (const TradeRow& row : record_.rows)
    if (row.setting.wait == Wait::kForPages)
      actions.emplace_back([&, options = options_of(row.setting, record_.parts)] {
        if (auto probe = Probe::create(model)) answer_all(*probe, points, options, answers);
      });
  for (const auto& action : actions) action();
  const std::vector<double> seconds = median_seconds(actions, kRounds);
  const double exact = seconds.front() / static_cast<double>(points.size());
  auto next = seconds.begin();
  for (TradeRow& row : record_.rows) {
    TradeResult& result = row.results[workload];
    if (row.setting.wait == Wait::kForPages) result.seconds = *next++;
    result.ratio_to_exact = result.seconds / static_cast<double>(result.points) / exact;
  }
}

}  // namespace planetree::tools
