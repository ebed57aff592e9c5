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

/// Shows the progress of long work: phase, percentage, rate and remaining time. On a terminal one
/// line is redrawn at most 5 times a second and erased at the end. Elsewhere a line is printed at
/// most every 5 seconds, so that short work leaves nothing in a log. With JSON each line is an
/// object of phase, done, total, unit, rate_per_second and remaining_seconds, null where unknown.
///
/// threads  any number in add() at once; start() and finish() by one thread while none is in add().
/// errors   a stream that cannot be written is ignored, so that the work goes on.
class Progress {
 public:
  enum class Style { kSilent, kLines, kBar, kJson };
  using Clock = std::function<std::chrono::nanoseconds()>;

  /// Writes to standard error: nothing if `quiet`, else JSON if `json`, else a bar if it is a
  /// terminal that can erase a line, else plain lines.
  Progress(bool quiet, bool json);
  /// Writes to a stream, which must outlive this, by a monotonic clock.
  Progress(std::FILE* stream, Style style, Clock clock);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// Begins a phase and ends the one before.
  ///
  /// phase  a few ASCII words, such as "sorting cells"
  /// total  number of steps; 0 if unknown, then only count and rate are shown
  /// unit   name of a step in the plural, such as "triangles"
  void start(std::string_view phase, std::uint64_t total, std::string_view unit);
  /// Reports `count` more steps. Reads a clock: call it once per some thousand cheap steps.
  void add(std::uint64_t count);
  /// Ends the phase and erases the bar. Does nothing without a phase.
  void finish();
  /// As finish(), and leaves a last line for people to read: on a terminal, and elsewhere if the
  /// work was so long that lines of it are there.
  void finish(std::string_view last_line);

 private:
  /// How far a phase is.
  struct Status {
    std::uint64_t done;
    double rate;                    // steps a second
    std::optional<double> seconds;  // remaining time
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
  bool drawn_ = false;  // the bar is on the screen
  bool wrote_line_ = false;
  // Relaxed order suffices for both. The count is only shown, and next_draw_ns_ only chooses the
  // thread that draws; the mutex guards the text.
  std::atomic<std::uint64_t> done_{0};
  std::atomic<std::int64_t> next_draw_ns_{0};
  std::mutex drawing_;
};

}  // namespace planetree::tools
