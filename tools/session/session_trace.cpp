#include "tools/session/session_trace.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <iterator>

namespace planetree::tools {
namespace {

constexpr auto kPause = std::chrono::milliseconds(2);

/// Returns the word for a lookup, or null for any other record.
const char* access_word(PageAccess::Event event) {
  switch (event) {
    case PageAccess::Event::kHit:
      return "hit";
    case PageAccess::Event::kPrefetched:
      return "prefetched";
    case PageAccess::Event::kMissed:
    case PageAccess::Event::kLate:
      return "missed";
    default:
      return nullptr;
  }
}

}  // namespace

PageTraceDrain::PageTraceDrain(const Model& model)
    : model_(model), thread_([this] {
        while (!stopping_.load(std::memory_order_relaxed)) {
          drain();
          std::this_thread::sleep_for(kPause);
        }
      }) {}

PageTraceDrain::~PageTraceDrain() { finish(); }

const std::vector<PageAccess>& PageTraceDrain::finish() {
  if (thread_.joinable()) {
    stopping_.store(true, std::memory_order_relaxed);
    thread_.join();
    drain();
  }
  return page_trace_;
}

void PageTraceDrain::drain() {
  std::array<PageAccess, 1024> drained;
  for (std::size_t got = drained.size(); got == drained.size();) {
    got = model_.drain_page_trace(drained);
    page_trace_.insert(page_trace_.end(), drained.begin(),
                       drained.begin() + static_cast<std::ptrdiff_t>(got));
  }
}

std::string touch_trace(std::span<const PageAccess> accesses) {
  std::string text = "tick,probe,page,level,access\n";
  for (const PageAccess& access : accesses) {
    const char* const word = access_word(access.event);
    if (word && !access.waits && access.query > 0)
      fmt::format_to(std::back_inserter(text), "{},{},{},{},{}\n", access.query - 1, access.probe,
                     access.page, access.level, word);
  }
  return text;
}

}  // namespace planetree::tools
