#pragma once

#include <httplib.h>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace planetree::tools {

/// A fixed number of threads that serve clients, and a queue of bounded length. While the queue is
/// full, enqueue() waits, so that further clients wait in the system.
class ServingThreads final : public httplib::TaskQueue {
 public:
  static constexpr std::size_t kThreads = 8, kMaxWaiting = 64;

  /// waiting  set to the number of clients that wait for a thread; must outlive this
  explicit ServingThreads(std::atomic<std::size_t>& waiting);
  ~ServingThreads() override;

  void enqueue(std::function<void()> task) override;
  /// Runs the tasks that wait and ends the threads.
  void shutdown() override;

 private:
  void serve();

  std::mutex mutex_;
  std::condition_variable has_task_, has_room_;
  std::deque<std::function<void()>> tasks_;
  std::atomic<std::size_t>& waiting_;
  bool is_ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace planetree::tools
