#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace planetree::tools {

/// Tells a person how far long work has come: phase, percentage, rate and
/// remaining time. On a terminal one line is redrawn at most 5 times a second and
/// wiped at the end; elsewhere plain lines follow at most every 5 seconds, so
/// short work leaves no trace in a log. For programs such a line is a JSON object:
/// phase, done, total, unit, rate_per_second and remaining_seconds, null where not known.
///
/// threads  add() may be called by any number of threads at once; start() and
///          finish() by one thread, while none is in add().
/// errors   a stream that cannot be written is ignored: progress is not the work.
class Progress {
 public:
  enum class Style { kSilent, kLines, kBar, kJson };
  using Clock = std::function<std::chrono::nanoseconds()>;

  /// Standard error: as JSON if that is wanted, else with a bar if it is a capable terminal.
  /// `quiet` silences it in any case.
  Progress(bool quiet, bool json);
  /// Any stream, which must outlive this object, and any monotonic clock.
  Progress(std::FILE* stream, Style style, Clock clock);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// Begins a phase; ends the one before.
  ///
  /// phase  what is being done, a few ASCII words: "sorting cells"
  /// total  steps in this phase; 0 if not known, then only count and rate show
  /// unit   what a step is, in the plural: "triangles"
  void start(std::string_view phase, std::uint64_t total, std::string_view unit);
  /// `count` more steps are done. Reads a clock, so call it once per some
  /// thousand cheap steps.
  void add(std::uint64_t count);
  /// Ends the phase and wipes the bar. Without a phase it does nothing.
  void finish();

 private:
  /// How far a phase is.
  struct Status {
    std::uint64_t done;
    double rate;                    // steps a second
    std::optional<double> seconds;  // that remain
  };

  void draw(std::chrono::nanoseconds now);
  Status status(std::chrono::nanoseconds now) const;
  std::string text(const Status& status) const;
  std::string json(const Status& status) const;

  std::FILE* stream_;
  Style style_;
  Clock clock_;
  std::string phase_;
  std::string unit_;
  std::uint64_t total_ = 0;
  std::chrono::nanoseconds started_{0};
  bool drawn_ = false;
  // Relaxed order suffices for both: the count is only shown, and the claim of a
  // drawing slot only picks a thread; the text itself is guarded by the mutex.
  std::atomic<std::uint64_t> done_{0};
  std::atomic<std::int64_t> next_draw_ns_{0};
  std::mutex drawing_;
};

}  // namespace planetree::tools
