#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "tools/trade/trade_record.h"

namespace planetree::tools {

/// Opens layers of a model for one probe within a budget.
OpenOptions trade_open_options(std::uint64_t memory_bytes, std::uint32_t layers);

/// Answers the points of workloads with one setting after the other, and compares the answers with
/// the exact ones.
class TradeMeasurement {
 public:
  /// done  called after each setting on each workload
  TradeMeasurement(std::filesystem::path file, TradeRecord& record, std::function<void()> done)
      : file_(std::move(file)), record_(record), done_(std::move(done)) {}

  /// Adds a workload to those measured. Answers its points exactly with the probe. The layers and
  /// the parts of the record are known.
  void add(TradeWorkload workload, std::vector<Vec3> points, Probe& probe);

  /// Adds a setting's row to the record: all but the time of settings that wait for pages. Opens
  /// the model for each workload, so that no page is in memory. A budget that is too small for the
  /// model is noted instead.
  ///
  /// errors  as Model::open()
  Result<void> measure(const TradeSetting& setting);

  /// Times the settings that wait for pages, in turn, after a round that is not timed. Then sets
  /// the ratios to exact answers. Called once, after all rows.
  void measure_times(const Model& model);

 private:
  struct Points {
    std::vector<Vec3> points;
    std::vector<ClosestPoint> exact;
  };

  void measure_times(const Model& model, std::size_t workload);

  const std::filesystem::path file_;
  TradeRecord& record_;
  const std::function<void()> done_;
  std::vector<Points> workloads_;  // as record_.workloads
};

}  // namespace planetree::tools
