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
class PageTraceDrain {
 public:
  /// Most that wait to be taken: what a probe may look for in the time of some pauses.
  static constexpr std::uint32_t kAccessesWaiting = 4096;

  explicit PageTraceDrain(const Model& model);
  ~PageTraceDrain();
  PageTraceDrain(const PageTraceDrain&) = delete;
  PageTraceDrain& operator=(const PageTraceDrain&) = delete;

  /// Ends the thread; all that was taken.
  const std::vector<PageAccess>& finish();

 private:
  void take();

  const Model& model_;
  std::vector<PageAccess> page_trace_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

/// The accesses of a session as CSV: a header, then tick,probe,page,level,access for each, where
/// access is hit, prefetched or missed. The session's first ask is before its ticks, and left out.
std::string touch_trace(std::span<const PageAccess> accesses);

}  // namespace planetree::tools
