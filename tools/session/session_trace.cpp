#include "tools/session/session_trace.h"

#include <chrono>
#include <span>

#include "planetree/stats.h"

namespace planetree::tools {

TraceHeader trace_header_of(const Model& model, const std::filesystem::path& file,
                            std::uint64_t memory_bytes, EvictionPolicy policy) {
  const ModelInfo& info = model.info();
  const Stats stats = model.stats();
  TraceHeader header;
  header.model = file.filename().string();
  header.content_id[0] = info.content_id[0];
  header.content_id[1] = info.content_id[1];
  header.memory_bytes = memory_bytes;
  header.frames = stats.frames;
  header.page_bytes = info.page_bytes;
  header.pages = info.pages;
  header.layers = stats.layers;
  header.policy = policy;
  return header;
}

void TraceRecorder::drain() {
  for (std::size_t count = drained_.size(); count == drained_.size();) {
    count = model_.drain_page_trace(drained_);
    const auto accesses = std::span(drained_).first(count);
    for (const PageAccess& access : accesses) prefetch_.add(access);
    if (written_) written_ = writer_.add(accesses);
  }
}

Result<void> TraceRecorder::finish(std::uint64_t ticks) {
  drain();
  if (written_) written_ = writer_.finish(ticks, model_.stats().page_trace_dropped);
  return written_;
}

DrainThread::DrainThread(TraceRecorder& recorder)
    : thread_([this, &recorder] {
        constexpr auto kPause = std::chrono::milliseconds(2);
        while (!stopping_.load(std::memory_order_relaxed)) {
          recorder.drain();
          std::this_thread::sleep_for(kPause);
        }
      }) {}

DrainThread::~DrainThread() {
  stopping_.store(true, std::memory_order_relaxed);
  thread_.join();
}

}  // namespace planetree::tools
