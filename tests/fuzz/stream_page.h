#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "octree/page/frame.h"

namespace planetree::octree {

/// One stream of a page, element by element. In the page it is byte-stream split.
struct PageStream {
  unsigned width = 1;            ///< bytes of an element
  std::uint8_t count = 0;        ///< index of the head's count that sets the length
  std::uint8_t per_record = 1;   ///< elements of a record
  bool by_plane = false;         ///< all records' first elements come first
  std::vector<std::byte> bytes;  ///< of all elements

  [[nodiscard]] std::size_t size() const { return bytes.size() / width; }
  std::span<std::byte> element(std::size_t index) {
    return std::span(bytes).subspan(index * width, width);
  }
  void resize(std::size_t elements);
  /// Inserts a copy of successive elements before them.
  void repeat(std::size_t first, std::size_t elements = 1);
  void erase(std::size_t first, std::size_t elements = 1);
};

/// The raw bytes of a distance page or a mask page as head and streams, by the tables of sections
/// 5.2 and 9.2 of the specification. Unlike RawPage it has every shape of page, and lengths can be
/// made to follow from contents or from the head, so that a change does not always end at the
/// first check.
class StreamPage {
 public:
  static constexpr std::size_t kHeadBytes = 40;
  static constexpr std::size_t kCounts = 10;  ///< 16-bit counts in the head, from byte 16 on
  static constexpr std::size_t kMaxBytes = std::size_t{1} << 18;

  /// Splits a page. Empty if it is shorter than its counts say.
  static std::optional<StreamPage> of(std::span<const std::byte> raw, bool is_mask,
                                      const BlockShape& shape);
  [[nodiscard]] std::vector<std::byte> bytes() const;

  std::array<std::byte, kHeadBytes>& head() { return head_; }
  std::vector<PageStream>& streams() { return streams_; }
  /// Index of the stream of pages that links to other pages lead to. The next has the records.
  [[nodiscard]] std::size_t linked_pages() const;
  /// Index of the stream of pages that lists lead to; only in a mask page. The next has the blocks.
  [[nodiscard]] std::size_t block_pages() const { return streams_.size() - 2; }

  [[nodiscard]] std::uint16_t count(std::size_t index) const;
  void set_count(std::size_t index, std::size_t value);

  /// Inserts a copy of a record, or erases a record, in all streams of this count.
  void repeat_record(std::size_t count_index, std::size_t record);
  void erase_record(std::size_t count_index, std::size_t record);

  /// Makes the head's counts follow from the streams that count something.
  void fit_head();
  /// Cuts or extends the streams to the lengths that the head states.
  void fit_streams();

 private:
  template <class Change>
  void change_records(std::size_t count_index, std::size_t record, Change change);
  [[nodiscard]] std::size_t elements_of(std::size_t stream) const;
  [[nodiscard]] std::size_t sum(std::size_t stream, unsigned mask = 0xff) const;
  [[nodiscard]] std::size_t corner_stream_bytes() const;
  void fit_distance_head();
  void fit_mask_head();

  bool is_mask_ = false;
  BlockShape shape_;
  std::array<std::byte, kHeadBytes> head_{};
  std::vector<PageStream> streams_;
  std::vector<std::byte> rest_;  ///< what follows the last stream
};

}  // namespace planetree::octree
