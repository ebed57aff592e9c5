#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "cache/page_map.h"
#include "cache/reader_slot.h"

namespace planetree::cache {
namespace {

/// Two threads that meet again and again, each time within some nanoseconds.
class Meeting {
 public:
  /// Announces that this thread (0 or 1) has come to the n-th meeting, n >= 1,
  /// and waits for the other.
  void meet(int me, std::uint32_t n) noexcept {
    come_[me].n.store(n, std::memory_order_release);
    std::uint32_t spins = 0;
    while (come_[1 - me].n.load(std::memory_order_acquire) < n) {
      if (++spins > 2000) std::this_thread::yield();
    }
    // Who comes last is first to go on: let each side lead at times.
    const std::uint32_t lag = (n * 2654435761u >> (me == 0 ? 20 : 24)) % 32;
    for (volatile std::uint32_t i = 0; i < lag; i = i + 1) {
    }
  }

 private:
  struct alignas(64) Come {
    std::atomic<std::uint32_t> n{0};
  };
  Come come_[2];
};

// The one moment the protocol depends on, many times over: a reader enters and
// looks a page up, while the writer withdraws it and looks at the reader. That
// the reader finds the page and the writer takes it for outside is what weaker
// memory orders would allow, and what processors then do.
TEST(SectionProtocol, WriterSeesEveryReaderThatFoundThePage) {
  constexpr std::uint32_t kMeetings = 40'000;
  ReaderSlot slot;
  std::vector<PageMap::Cell> cells(1);
  const PageMap map(cells);
  Meeting meeting;
  std::vector<char> reader_found(kMeetings);
  std::vector<char> writer_saw(kMeetings);

  std::thread reader([&] {
    for (std::uint32_t i = 0; i < kMeetings; ++i) {
      meeting.meet(0, 2 * i + 1);
      slot.enter();
      reader_found[i] = map.find(0) != kNoFrame;
      meeting.meet(0, 2 * i + 2);
      slot.leave();
    }
  });
  for (std::uint32_t i = 0; i < kMeetings; ++i) {
    map.publish(0, 7);
    meeting.meet(1, 2 * i + 1);
    map.withdraw(0);
    writer_saw[i] = ReaderSlot::is_inside(slot.sequence_after_withdrawal());
    meeting.meet(1, 2 * i + 2);
  }
  reader.join();

  std::uint32_t missed = 0;
  for (std::uint32_t i = 0; i < kMeetings; ++i) missed += reader_found[i] && !writer_saw[i];
  EXPECT_EQ(missed, 0u);
}

}  // namespace
}  // namespace planetree::cache
