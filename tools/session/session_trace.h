#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "planetree/model.h"
#include "planetree/trace.h"

namespace planetree::tools {

/// Takes the pages that a model's asks look for, as they come, on a thread of its own.
class TouchTaker {
 public:
  /// Most that wait to be taken: what a probe may look for in the time of some pauses.
  static constexpr std::uint32_t kTouchesWaiting = 4096;

  explicit TouchTaker(const Model& model);
  ~TouchTaker();
  TouchTaker(const TouchTaker&) = delete;
  TouchTaker& operator=(const TouchTaker&) = delete;

  /// Ends the thread; all that was taken.
  const std::vector<PageTouch>& finish();

 private:
  void take();

  const Model& model_;
  std::vector<PageTouch> touches_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

/// The touches of a session as CSV: a header, then tick,probe,page,level,touch for each, where
/// touch is hit, prefetched or missed. The session's first ask is before its ticks, and left out.
std::string touch_trace(std::span<const PageTouch> touches);

}  // namespace planetree::tools
