#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "octree/page/frame.h"
#include "query/model_state.h"
#include "query/serve/page_accessor.h"
#include "tests/query/sample_model.h"

// Guarantees about frames that a PageAccessor has returned.
namespace planetree::query {
namespace {

class PageAccessorTest : public testing::Test {
 protected:
  void open(std::uint64_t budget_bytes) {
    OpenOptions options;
    options.memory_budget_bytes = budget_bytes;
    options.max_probes = 1;
    auto state = ModelState::open(sample_.path(), options);
    if (!state) std::abort();
    state_ = *std::move(state);
    reader_.emplace(*state_->claim_reader());
  }
  static std::uint32_t number_in(const std::byte* frame) {
    return reinterpret_cast<const octree::FrameHeader*>(frame)->page_number;
  }

  const SampleModel sample_{octree::sphere(4)};
  std::unique_ptr<ModelState> state_;
  std::optional<cache::Reader> reader_;
};

// Records the frames that an accessor returned, and the pages in them, until they are released.
class Kept {
 public:
  explicit Kept(octree::FrameReleaseHook& release_hook) {
    release_hook = {this, [](void* kept) noexcept { static_cast<Kept*>(kept)->on_release(); }};
  }
  void add(const std::byte* frame, std::uint32_t page) { frames_.emplace_back(frame, page); }
  void on_release() {
    check();
    frames_.clear();
    ++times_called_;
  }
  void check() const {
    for (const auto& [frame, page] : frames_)
      EXPECT_EQ(reinterpret_cast<const octree::FrameHeader*>(frame)->page_number, page);
  }
  std::size_t size() const { return frames_.size(); }
  unsigned times_called() const { return times_called_; }

 private:
  std::vector<std::pair<const std::byte*, std::uint32_t>> frames_;
  unsigned times_called_ = 0;
};

TEST_F(PageAccessorTest, CallsTheReleaseHookBeforeAFrameIsReused) {
  open(sample_.min_budget());
  const std::uint64_t frames = state_->cache().stats().frame_count;
  ASSERT_LT(2 * frames, sample_.page_count()) << "each round has to take frames of others";
  PageAccessor accessor(*reader_, Wait::kForPages);
  Kept kept(*accessor.pages().release_hook);
  for (unsigned round = 0; round < 3; ++round)
    for (std::uint32_t page = 0; page < sample_.page_count(); ++page) {
      const std::byte* frame = accessor.page(page);
      ASSERT_NE(frame, nullptr) << page;
      kept.add(frame, page);
      kept.check();
    }
  EXPECT_GT(kept.times_called(), sample_.page_count());
}

TEST_F(PageAccessorTest, KeepsFramesOfResidentPagesAcrossCalls) {
  open(std::uint64_t{64} << 20);
  for (std::uint32_t page = 0; page < sample_.page_count(); ++page)
    ASSERT_NE(PageAccessor(*reader_, Wait::kForPages).page(page), nullptr);
  PageAccessor accessor(*reader_, Wait::kForPages);
  Kept kept(*accessor.pages().release_hook);
  std::size_t most = 0;
  for (unsigned call = 0; call < 2000; ++call) {
    const std::uint32_t page = call % sample_.page_count();
    kept.add(accessor.page(page), page);
    most = std::max(most, kept.size());
  }
  // Sections are long, but they end: other threads wait for that.
  EXPECT_GE(most, 100u);
  EXPECT_LT(most, 1000u);
}

TEST_F(PageAccessorTest, FrameTableGivesTheFramesOfPages) {
  open(std::uint64_t{64} << 20);
  const octree::FrameTable table = frames_of(*reader_);
  const std::uint32_t last = sample_.page_count() - 1;
  PageAccessor accessor(*reader_, Wait::kForPages);
  const std::byte* const first_frame = accessor.page(0);
  EXPECT_EQ(table.frame_of(0), first_frame);
  ASSERT_EQ(accessor.peek(last), nullptr);
  EXPECT_EQ(table.frame_of(last), table.frames) << "of what is not resident some frame";
  const std::byte* const last_frame = accessor.page(last);
  EXPECT_EQ(table.frame_of(last), last_frame);
  EXPECT_EQ(number_in(last_frame), last);
}

}  // namespace
}  // namespace planetree::query
