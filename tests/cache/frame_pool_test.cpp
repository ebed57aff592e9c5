#include "cache/frame_pool.h"

#include <gtest/gtest.h>

#include <cstring>
#include <type_traits>
#include <utility>

namespace planetree::cache {
namespace {

static_assert(!std::is_copy_constructible_v<FramePool> && !std::is_copy_assignable_v<FramePool>);
static_assert(std::is_nothrow_move_constructible_v<FramePool>);

TEST(FramePool, FramesAreAlignedAndDisjoint) {
  for (const std::uint32_t frame_bytes : {1u, 64u, 100u, 4096u, 65536u}) {
    const Result<FramePool> pool = FramePool::create(40, frame_bytes);
    ASSERT_TRUE(pool);
    EXPECT_EQ(pool->frame_count(), 40u);
    EXPECT_EQ(pool->frame_bytes(), frame_bytes);
    for (std::uint32_t i = 0; i < 40; ++i) {
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(pool->frame(i)) % 64, 0u);
      std::memset(pool->frame(i), static_cast<int>(i), frame_bytes);
    }
    for (std::uint32_t i = 0; i < 40; ++i) {
      EXPECT_EQ(pool->frame(i)[0], std::byte{static_cast<unsigned char>(i)});
      EXPECT_EQ(pool->frame(i)[frame_bytes - 1], std::byte{static_cast<unsigned char>(i)});
    }
  }
}

TEST(FramePool, ArenaIsBarelyLargerThanItsFrames) {
  const Result<FramePool> pool = FramePool::create(1000, 4160);  // more than a huge page
  ASSERT_TRUE(pool);
  EXPECT_GE(pool->arena_bytes(), 1000u * 4160u);
  EXPECT_LT(pool->arena_bytes(), 1000u * 4160u + 65536u);
}

TEST(FramePool, ArenaOfAHugePageOrMoreStartsOnAHugePage) {
  const Result<FramePool> pool = FramePool::create(1024, 4096);
  ASSERT_TRUE(pool);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(pool->frame(0)) % (2u << 20), 0u);
}

TEST(FramePool, MoveKeepsFrameAddressesAndContents) {
  Result<FramePool> pool = FramePool::create(4, 128);
  ASSERT_TRUE(pool);
  std::byte* const frame = pool->frame(3);
  *frame = std::byte{42};
  FramePool moved_pool = *std::move(pool);
  EXPECT_EQ(moved_pool.frame(3), frame);
  Result<FramePool> other = FramePool::create(2, 64);
  ASSERT_TRUE(other);
  *other = std::move(moved_pool);
  EXPECT_EQ(other->frame(3), frame);
  EXPECT_EQ(*other->frame(3), std::byte{42});
}

TEST(FramePool, ErrorNamesTheBytesTheSystemRefused) {
  // More than an address space holds.
  const Result<FramePool> pool = FramePool::create(0xfffffff0u, 1u << 28);
  ASSERT_FALSE(pool);
  EXPECT_EQ(pool.error().code, ErrorCode::kNoMemory);
  EXPECT_NE(std::strstr(pool.error().text, "1152921500311879680"), nullptr) << pool.error().text;
}

}  // namespace
}  // namespace planetree::cache
