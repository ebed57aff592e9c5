#pragma once

#include <cstdint>

#include "tests/cache/explored_cache.h"
#include "tests/cache/explorer/program.h"

namespace planetree::cache {

/// Two readers share one slot, one after the other, while a writer reuses the page's frame for
/// another page.
class HandoverProgram final : public explorer::Program {
 public:
  std::uint32_t thread_count() const noexcept override { return kReaders + 1; }

  void run(std::uint32_t thread) override {
    if (thread == kReaders) {
      write();
    } else {
      read();
    }
  }

 private:
  static constexpr std::uint32_t kReaders = 2;

  void read() {
    ExploredCache::Slot& slot = cache_.slot(0);
    if (!slot.try_claim()) {
      explorer::Execution::current().yield();
      if (!slot.try_claim()) return;
    }
    fetchers_.write(fetchers_.read() + 1);
    slot.enter();
    if (const std::uint32_t frame = cache_.map().find(0); frame != kNoFrame) cache_.read(frame, 0);
    slot.leave();
    slot.release();
  }

  void write() {
    cache_.map().withdraw(0);
    cache_.limbo().retire(0, 0);
    std::uint32_t frame = cache_.limbo().take(0);
    if (frame == kNoFrame) {
      explorer::Execution::current().yield();
      frame = cache_.limbo().take(0);
    }
    if (frame != kNoFrame) cache_.install(frame, 1);
  }

  ExploredCache cache_{1, 1, 2, 1};
  /// Stands for the data of the slot's reader: a data race unless release() and try_claim() order
  /// it.
  explorer::Plain<std::uint32_t> fetchers_{0};
};

}  // namespace planetree::cache
