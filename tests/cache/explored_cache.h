#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cache/limbo.h"
#include "cache/protocol.h"
#include "tests/cache/explored_atomics.h"
#include "tests/cache/explorer/atomic.h"

namespace planetree::cache {

/// The parts of a PageCache over explorable atomics, with a few pages and frames. A frame is two
/// words, each the number of its page: so a read of another page's frame is detected, and a read of
/// a frame that is being written is a data race.
class ExploredCache {
 public:
  using Slot = BasicReaderSlot<ExploredAtomics>;
  using Map = BasicPageMap<ExploredAtomics>;
  using Limbo = BasicLimbo<ExploredAtomics>;

  /// Pages 0 ... frame_count - 1 start in the frames of the same number.
  ExploredCache(std::uint32_t slot_count, std::uint32_t frame_count, std::uint32_t page_count,
                std::uint32_t fetcher_count)
      : slots_(slot_count),
        frames_(frame_count),
        cells_(page_count),
        entries_(fetcher_count),
        stamps_(std::size_t{fetcher_count} * slot_count) {
    for (std::uint32_t i = 0; i < frame_count; ++i) install(i, i);
  }

  Slot& slot(std::uint32_t index) { return slots_[index]; }
  const Map& map() const { return map_; }
  Limbo& limbo() { return limbo_; }

  /// Writes a page into a frame without publishing it.
  void fill(std::uint32_t frame, std::uint32_t page) {
    for (explorer::Plain<std::uint32_t>& word : frames_[frame].words) word.write(page);
    frames_[frame].page = page;
  }

  /// Writes a page into a frame and publishes it.
  void install(std::uint32_t frame, std::uint32_t page) {
    fill(frame, page);
    map_.publish(page, frame);
  }

  std::uint32_t page_in(std::uint32_t frame) const { return frames_[frame].page; }

  /// Reads all words of a frame found for `page`.
  void read(std::uint32_t frame, std::uint32_t page) const {
    for (const explorer::Plain<std::uint32_t>& word : frames_[frame].words) {
      if (word.read() != page) explorer::Execution::current().fail("a frame of another page");
    }
  }

 private:
  struct Frame {
    std::array<explorer::Plain<std::uint32_t>, 2> words;
    std::uint32_t page = 0;  ///< for the writer only
  };

  std::vector<Slot> slots_;
  std::vector<Frame> frames_;
  std::vector<Map::Cell> cells_;
  std::vector<Limbo::Entry> entries_;
  std::vector<std::uint64_t> stamps_;
  Map map_{cells_};
  Limbo limbo_{slots_, entries_, stamps_};
};

}  // namespace planetree::cache
