// A box that one thread writes and many read, without locks: words between two
// numbers that are equal and even unless a write is going on. A larger program
// for the explorer, and the pattern to explore where such a box is shipped.

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "tests/cache/explorer/atomic.h"
#include "tests/cache/explorer/explore.h"

namespace planetree::explorer {
namespace {

struct BoxOrders {
  std::memory_order first_number_load = std::memory_order_acquire;
  std::memory_order word_store = std::memory_order_release;
  std::memory_order word_load = std::memory_order_acquire;
  std::memory_order last_number_store = std::memory_order_release;
};

class Box {
 public:
  explicit Box(const BoxOrders& orders) : orders_(orders) {}

  /// Both words become `value`.
  void write(int value) {
    const int number = number_.load(std::memory_order_relaxed);
    // Relaxed: who loads a word of this write acquires it, and so this number.
    number_.store(number + 1, std::memory_order_relaxed);
    for (Atomic<int>& word : words_) word.store(value, orders_.word_store);
    number_.store(number + 2, orders_.last_number_store);
  }

  /// Nothing if a write is going on or came between.
  std::optional<std::array<int, 2>> read() const {
    const int number = number_.load(orders_.first_number_load);
    if (number % 2 != 0) return std::nullopt;
    std::array<int, 2> copy;
    for (std::size_t i = 0; i < copy.size(); ++i) copy[i] = words_[i].load(orders_.word_load);
    if (number_.load(std::memory_order_relaxed) != number) return std::nullopt;
    return copy;
  }

 private:
  BoxOrders orders_;
  Atomic<int> number_{0};
  std::array<Atomic<int>, 2> words_{};
};

/// One thread writes 1 and 2, the others read twice each.
class BoxProgram final : public Program {
 public:
  BoxProgram(const BoxOrders& orders, std::uint32_t readers, std::uint64_t& reads_of_the_last)
      : readers_(readers), reads_of_the_last_(reads_of_the_last), box_(orders) {}

  std::uint32_t thread_count() const noexcept override { return readers_ + 1; }

  void run(std::uint32_t thread) override {
    if (thread == readers_) {
      box_.write(1);
      box_.write(2);
    } else {
      int last = 0;
      for (int i = 0; i < 2; ++i) last = read(last);
    }
  }

 private:
  int read(int last) {
    const std::optional<std::array<int, 2>> copy = box_.read();
    if (!copy) return last;
    if ((*copy)[0] != (*copy)[1]) Execution::current().fail("a torn read");
    if ((*copy)[0] < last) Execution::current().fail("an older value than before");
    reads_of_the_last_ += (*copy)[0] == 2 ? 1 : 0;
    return (*copy)[0];
  }

  const std::uint32_t readers_;
  std::uint64_t& reads_of_the_last_;
  Box box_;
};

Report explore_box(const BoxOrders& orders, std::uint32_t readers, std::uint32_t stops) {
  std::uint64_t reads_of_the_last = 0;
  Report report = explore_all(
      [&] { return std::make_unique<BoxProgram>(orders, readers, reads_of_the_last); }, stops);
  EXPECT_TRUE(reads_of_the_last > 0 || !report.failure.empty());
  return report;
}

TEST(Seqlock, ReturnsNoTornReadInAnyRun) { EXPECT_EQ(explore_box({}, 1, kAnyStops).failure, ""); }

TEST(Seqlock, ReturnsNoTornReadToTwoReaders) {
  EXPECT_EQ(explore_box({}, 2, kFewStops).failure, "");
}

struct WeakenedBox {
  const char* name;
  BoxOrders orders;
};

const WeakenedBox kWeakenedBoxes[] = {
    {"FirstNumberLoad", {.first_number_load = std::memory_order_relaxed}},
    {"WordStore", {.word_store = std::memory_order_relaxed}},
    {"WordLoad", {.word_load = std::memory_order_relaxed}},
    {"LastNumberStore", {.last_number_store = std::memory_order_relaxed}},
};

class WeakenedSeqlock : public testing::TestWithParam<WeakenedBox> {};

TEST_P(WeakenedSeqlock, IsCaught) {
  const Report report = explore_box(GetParam().orders, 1, kFewStops);
  EXPECT_NE(report.failure.find("a torn read"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Orders, WeakenedSeqlock, testing::ValuesIn(kWeakenedBoxes),
                         [](const testing::TestParamInfo<WeakenedBox>& weakened) {
                           return std::string(weakened.param.name);
                         });

}  // namespace
}  // namespace planetree::explorer
