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

/// Drains a model's page trace continuously, on a thread of its own.
class PageTraceDrain {
 public:
  /// Capacity of the page trace that the model should have: more than a probe's page lookups during
  /// several pauses of the thread.
  static constexpr std::uint32_t kAccessesWaiting = 4096;

  /// Starts the thread. `model` must outlive this.
  explicit PageTraceDrain(const Model& model);
  ~PageTraceDrain();
  PageTraceDrain(const PageTraceDrain&) = delete;
  PageTraceDrain& operator=(const PageTraceDrain&) = delete;

  /// Ends the thread. Returns all accesses, valid as long as this object.
  const std::vector<PageAccess>& finish();

 private:
  void drain();

  const Model& model_;
  std::vector<PageAccess> page_trace_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

/// The accesses of a session as CSV: a header, then tick,probe,page,level,access for each, where
/// access is hit, prefetched or missed. Skips the session's first query, which precedes the ticks.
std::string touch_trace(std::span<const PageAccess> accesses);

}  // namespace planetree::tools
