#include "cache/prefaulted_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

namespace planetree::cache {
namespace {

constexpr std::uint64_t kHuge = std::uint64_t{2} << 20;

TEST(PrefaultedMemory, ClaimsWholePages) {
  EXPECT_EQ(PrefaultedMemory::claimed_bytes(1), 4096u);
  EXPECT_EQ(PrefaultedMemory::claimed_bytes(4096), 4096u);
  EXPECT_EQ(PrefaultedMemory::claimed_bytes(4097), 8192u);
  EXPECT_EQ(PrefaultedMemory::claimed_bytes(~std::uint64_t{0}), ~std::uint64_t{0}) << "no wrapping";
}

TEST(PrefaultedMemory, RoundsUpToAHugePageFromThreeQuartersOn) {
  EXPECT_EQ(PrefaultedMemory::claimed_bytes(kHuge / 4 * 3 - 4096), kHuge / 4 * 3 - 4096);
  EXPECT_EQ(PrefaultedMemory::claimed_bytes(kHuge / 4 * 3), kHuge);
  EXPECT_EQ(PrefaultedMemory::claimed_bytes(kHuge), kHuge);
  EXPECT_EQ(PrefaultedMemory::claimed_bytes(kHuge + 1), kHuge + 4096);
}

TEST(PrefaultedMemory, ClaimedMemoryIsZeroAndOfTheStatedSize) {
  for (const std::uint64_t bytes : {std::uint64_t{100}, kHuge / 10 * 9, kHuge + 5000}) {
    const auto memory = PrefaultedMemory::claim(bytes);
    ASSERT_TRUE(memory);
    EXPECT_EQ(memory->bytes(), PrefaultedMemory::claimed_bytes(bytes));
    EXPECT_TRUE(std::all_of(memory->data(), memory->data() + memory->bytes(),
                            [](std::byte byte) { return byte == std::byte{0}; }));
    if (memory->bytes() >= kHuge) {
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory->data()) % kHuge, 0u);
    }
  }
}

TEST(PrefaultedMemory, ReservedMemoryIsThereOnceItIsCommitted) {
  const auto memory = PrefaultedMemory::reserve(std::uint64_t{1} << 30);
  ASSERT_TRUE(memory);
  ASSERT_TRUE(memory->commit(5000, 4000, false));
  std::byte* const data = memory->data();
  EXPECT_TRUE(
      std::all_of(data + 4096, data + 12288, [](std::byte byte) { return byte == std::byte{0}; }));
  data[5000] = data[12287] = std::byte{7};
  // Parts that are committed again keep their content.
  ASSERT_TRUE(memory->commit(8192, 10000, false));
  EXPECT_EQ(data[5000], std::byte{7});
  EXPECT_EQ(data[12287], std::byte{7});
  EXPECT_EQ(data[18191], std::byte{0});
  // Only whole system pages of the part are given back.
  memory->discard(5000, 10000);
  EXPECT_EQ(data[5000], std::byte{7});
  ASSERT_TRUE(memory->commit(5000, 10000, false));
  EXPECT_EQ(data[5000], std::byte{7});
  EXPECT_EQ(data[12287], std::byte{0}) << "the content of discarded pages is lost";
}

}  // namespace
}  // namespace planetree::cache
