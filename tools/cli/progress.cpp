#include "tools/cli/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

#include "tools/cli/size_text.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {
namespace {

using std::chrono::nanoseconds;

constexpr nanoseconds kBarInterval = std::chrono::milliseconds(200);
constexpr nanoseconds kLineInterval = std::chrono::seconds(5);

nanoseconds steady_now() { return std::chrono::steady_clock::now().time_since_epoch(); }

Progress::Style stderr_style(bool quiet, bool json) {
  if (quiet) return Progress::Style::kSilent;
  if (json) return Progress::Style::kJson;
  // A dumb terminal cannot erase a line.
  const char* terminal = std::getenv("TERM");
  const bool capable = terminal != nullptr && std::string_view(terminal) != "dumb";
  return capable && isatty(STDERR_FILENO) != 0 ? Progress::Style::kBar : Progress::Style::kLines;
}

std::size_t terminal_columns(std::FILE* stream) {
  winsize size{};
  if (ioctl(fileno(stream), TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

std::string duration_text(double seconds) {
  constexpr double kLongestSeconds = 359'999;
  const auto whole = static_cast<std::uint64_t>(std::min(seconds, kLongestSeconds) + 0.5);
  if (whole >= 3600)
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

std::string bar_text(std::uint64_t done, std::uint64_t total, std::size_t columns) {
  const double part = static_cast<double>(std::min(done, total)) / static_cast<double>(total);
  const auto filled = static_cast<std::size_t>(part * static_cast<double>(columns));
  return fmt::format("  [{:.<{}}]", std::string(filled, '#'), columns);
}

}  // namespace

Progress::Progress(bool quiet, bool json)
    : Progress(stderr, stderr_style(quiet, json), steady_now) {}

Progress::Progress(std::FILE* stream, Style style, Clock clock)
    : stream_(stream), style_(style), clock_(std::move(clock)) {
  // The first line is due after a full interval, so that short work is silent.
  const nanoseconds first = style_ == Style::kBar ? nanoseconds(0) : kLineInterval;
  next_draw_ns_.store((clock_() + first).count(), std::memory_order_relaxed);
}

Progress::~Progress() { finish(); }

void Progress::start(std::string_view phase, std::uint64_t total, std::string_view unit) {
  const std::lock_guard lock(drawing_);
  phase_ = phase;
  unit_ = unit;
  total_ = total;
  started_ = clock_();
  done_.store(0, std::memory_order_relaxed);
}

void Progress::add(std::uint64_t count) {
  done_.fetch_add(count, std::memory_order_relaxed);
  if (style_ == Style::kSilent) return;
  const nanoseconds now = clock_();
  std::int64_t due = next_draw_ns_.load(std::memory_order_relaxed);
  if (now.count() < due) return;
  const nanoseconds interval = style_ == Style::kBar ? kBarInterval : kLineInterval;
  // The thread that advances the due time draws; the others continue their work.
  if (next_draw_ns_.compare_exchange_strong(due, (now + interval).count(),
                                            std::memory_order_relaxed)) {
    draw(now);
  }
}

void Progress::finish() {
  const std::lock_guard lock(drawing_);
  if (drawn_ && style_ == Style::kBar) {
    std::fputs("\r\033[K", stream_);
    std::fflush(stream_);
  }
  drawn_ = false;
}

void Progress::finish(std::string_view last_line) {
  finish();
  if (style_ != Style::kBar && !(style_ == Style::kLines && wrote_line_)) return;
  fmt::print(stream_, "{}\n", last_line);
  std::fflush(stream_);
}

Progress::Status Progress::status(nanoseconds now) const {
  Status status{done_.load(std::memory_order_relaxed), 0, {}};
  const double elapsed = std::chrono::duration<double>(now - started_).count();
  if (elapsed > 0) status.rate = static_cast<double>(status.done) / elapsed;
  if (total_ > 0 && status.rate > 0)
    status.seconds = static_cast<double>(total_ - std::min(status.done, total_)) / status.rate;
  return status;
}

std::string Progress::text(const Status& status) const {
  const std::string speed = fmt::format("{} {}/s", short_count(status.rate), unit_);
  if (total_ == 0) return fmt::format("  {} {}  {}", grouped_count(status.done), unit_, speed);
  const double left = static_cast<double>(total_ - std::min(status.done, total_));
  const std::string remaining = status.seconds ? duration_text(*status.seconds) : "?";
  const double percent = 100 * (1 - left / static_cast<double>(total_));
  return fmt::format("  {:3}%  {}  {} left", static_cast<int>(percent), speed, remaining);
}

std::string Progress::json(const Status& status) const {
  nlohmann::ordered_json event = {{"phase", phase_},
                                  {"done", status.done},
                                  {"total", nullptr},
                                  {"unit", unit_},
                                  {"rate_per_second", status.rate},
                                  {"remaining_seconds", nullptr}};
  if (total_ > 0) event["total"] = total_;
  if (status.seconds) event["remaining_seconds"] = *status.seconds;
  return json_line(event);
}

void Progress::draw(nanoseconds now) {
  const std::lock_guard lock(drawing_);
  const Status status = this->status(now);
  if (style_ == Style::kJson) {
    std::fputs(json(status).c_str(), stream_);
    return;
  }
  const std::string text = this->text(status);
  if (style_ == Style::kLines) {
    fmt::print(stream_, "{}{}\n", phase_, text);
    wrote_line_ = true;
    return;
  }
  constexpr std::size_t kWidestBar = 40;
  constexpr std::size_t kBarFrame = 4;
  // One column stays free, because some terminals wrap when the last column is used.
  const std::size_t columns = terminal_columns(stream_) - 1;
  const std::size_t used = phase_.size() + text.size() + kBarFrame;
  std::string bar;
  if (total_ > 0 && used < columns) {
    bar = bar_text(status.done, total_, std::min(kWidestBar, columns - used));
  }
  fmt::print(stream_, "\r\033[K{}", (phase_ + bar + text).substr(0, columns));
  std::fflush(stream_);
  drawn_ = true;
}

}  // namespace planetree::tools
