#include "tools/view/serving_threads.h"

#include <utility>

namespace planetree::tools {

ServingThreads::ServingThreads(std::atomic<std::size_t>& waiting) : waiting_(waiting) {
  threads_.reserve(kThreads);
  for (std::size_t i = 0; i < kThreads; ++i) threads_.emplace_back([this] { serve(); });
}

ServingThreads::~ServingThreads() { shutdown(); }

void ServingThreads::enqueue(std::function<void()> task) {
  std::unique_lock lock(mutex_);
  has_room_.wait(lock, [this] { return tasks_.size() < kMaxWaiting; });
  tasks_.push_back(std::move(task));
  waiting_ = tasks_.size();
  has_task_.notify_one();
}

void ServingThreads::shutdown() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  has_task_.notify_all();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

void ServingThreads::serve() {
  while (true) {
    std::function<void()> task;
    {
      std::unique_lock lock(mutex_);
      has_task_.wait(lock, [this] { return is_ending_ || !tasks_.empty(); });
      if (tasks_.empty()) return;
      task = std::move(tasks_.front());
      tasks_.pop_front();
      waiting_ = tasks_.size();
    }
    has_room_.notify_one();
    task();
  }
}

}  // namespace planetree::tools
