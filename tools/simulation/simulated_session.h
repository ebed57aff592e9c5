#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/probe.h"
#include "planetree/trace.h"
#include "tools/session/session.h"
#include "tools/simulation/simulated_disk.h"
#include "tools/trace_file/prefetch_figures.h"
#include "tools/trace_file/trace_header.h"

namespace planetree::query {
class FetchWorker;
}

namespace planetree::tools {

/// Options of a simulated session.
struct SimulationOptions {
  std::filesystem::path file;
  std::uint64_t memory_bytes = OpenOptions().memory_budget_bytes;  ///< the trace comes on top
  EvictionPolicy policy = OpenOptions().policy;
  std::uint32_t layers = kAllLayers;
  std::uint32_t rate_hz = 1000;       ///< ticks per second, 1 or more
  std::uint64_t latency_ns = 85'000;  ///< time in which the disk reads a page
  double radius = 0;                  ///< of a ball as tool, model units; 0: a point
  bool tells_motion = true;           ///< call Probe::motion at each tick
  /// kForPages: the queries wait for their pages, and there is no fetch thread. No answer
  /// lacks a page, and pages are read because queries miss them alone.
  Wait wait = Wait::kNever;
};

/// What a simulated session comes to.
struct SimulatedRecord {
  std::vector<Tick> ticks;  ///< with latencies of 0: queries take no simulated time
  PrefetchFigures prefetch;
  Stats stats;
};

/// A haptic session that depends on the file and the options alone, to the bit: the real engine on
/// a simulated disk and clock, in one thread.
///
/// A tick calls Probe::motion and makes a real-time query, in no time. The worker of the fetch
/// thread works between the ticks. Each page that it reads takes the latency of the disk, and ticks
/// that are due meanwhile find the page not yet there: they run while the worker waits for the
/// disk. Besides reading, an action of the worker takes kActionNs. It looks for work as often as a
/// real fetch thread does.
///
/// One thread at a time may use it. Any number of sessions may run on other threads.
class SimulatedSession {
 public:
  /// Takes the records of the page trace, in the order in which things happened.
  using Sink = std::function<void(std::span<const PageAccess>)>;

  /// Opens the model.
  ///
  /// errors  as Model::open; kNoMemory also if the trace has no room for all that open does
  static Result<std::unique_ptr<SimulatedSession>> open(const SimulationOptions& options);
  ~SimulatedSession();
  SimulatedSession(const SimulatedSession&) = delete;
  SimulatedSession& operator=(const SimulatedSession&) = delete;

  const Model& model() const { return *model_; }
  /// Facts for the header of a trace file.
  TraceHeader trace_header() const;
  /// Runs a tick for each position, model units. Called once.
  SimulatedRecord run(std::span<const Vec3> path, const Sink& sink = {});

 private:
  explicit SimulatedSession(const SimulationOptions& options);
  Result<void> open_model();
  std::uint64_t due_ns(std::size_t tick) const;
  void run_tick();
  void run_ticks_before(std::uint64_t time_ns);
  void begin_event(std::uint64_t time_ns);
  void run_ticks();
  void let_worker_act();
  void wait_for_disk();
  void drain();

  static constexpr std::uint64_t kActionNs = 5'000;
  // Words of a page trace, enough for what open does with models of some hundred million triangles.
  static constexpr std::uint32_t kTraceWords = std::uint32_t{1} << 20;

  const SimulationOptions options_;
  const std::chrono::nanoseconds period_;
  SimulatedDisk disk_;
  SimulatedClock clock_;
  const std::atomic<bool> never_{false};
  std::optional<Model> model_;
  std::optional<Probe> probe_;
  std::optional<TouchTool> tool_;
  std::unique_ptr<query::FetchWorker> worker_;
  QueryOptions query_options_;
  std::span<const Vec3> path_;
  const Sink* sink_ = nullptr;
  std::vector<PageAccess> drained_;
  SimulatedRecord record_;
  std::uint64_t next_look_ns_ = 0;    // of the worker
  std::uint64_t last_action_ns_ = 0;  // of the worker
};

}  // namespace planetree::tools
