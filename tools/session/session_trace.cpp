#include "tools/session/session_trace.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <iterator>

namespace planetree::tools {
namespace {

constexpr auto kPause = std::chrono::milliseconds(2);

const char* touch_word(PageTouch::Kind kind) {
  switch (kind) {
    case PageTouch::Kind::kHit:
      return "hit";
    case PageTouch::Kind::kPrefetched:
      return "prefetched";
    case PageTouch::Kind::kMissed:
      return "missed";
  }
  return "";
}

}  // namespace

TouchTaker::TouchTaker(const Model& model)
    : model_(model), thread_([this] {
        while (!stopping_.load(std::memory_order_relaxed)) {
          take();
          std::this_thread::sleep_for(kPause);
        }
      }) {}

TouchTaker::~TouchTaker() { finish(); }

const std::vector<PageTouch>& TouchTaker::finish() {
  if (thread_.joinable()) {
    stopping_.store(true, std::memory_order_relaxed);
    thread_.join();
    take();
  }
  return touches_;
}

void TouchTaker::take() {
  std::array<PageTouch, 1024> taken;
  for (std::size_t got = taken.size(); got == taken.size();) {
    got = model_.take_touches(taken);
    touches_.insert(touches_.end(), taken.begin(),
                    taken.begin() + static_cast<std::ptrdiff_t>(got));
  }
}

std::string touch_trace(std::span<const PageTouch> touches) {
  std::string text = "tick,probe,page,level,touch\n";
  for (const PageTouch& touch : touches)
    if (touch.ask > 0)
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", touch.ask - 1, touch.probe,
                     touch.page, touch.level, touch_word(touch.kind));
  return text;
}

}  // namespace planetree::tools
