#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "planetree/trace.h"
#include "query/serve/page_trace.h"
#include "storage/file/page_file.h"

namespace planetree::query {

/// Decodes the words of a model's page traces, in the order of their times. It also finds what no
/// single thread knows: whether a page that is hit, evicted or missed was read for a motion, or is
/// being read for one. What it keeps from call to call lies in the PageTraces, so objects are made
/// for each call. One thread at a time may decode.
class TraceDecoder {
 public:
  TraceDecoder(PageTraces& traces, const storage::PageFile& file) noexcept
      : traces_(traces), file_(file) {}

  /// Moves the oldest records to `accesses`. Returns their number.
  std::size_t decode(std::span<PageAccess> accesses) noexcept;

 private:
  // Bits of PageTraces::states_of_pages.
  static constexpr std::uint8_t kUnused = 1;    // read for a motion; not hit since
  static constexpr std::uint8_t kInFlight = 2;  // being read for a motion

  bool look(std::uint32_t reader) noexcept;
  static bool is_record(TraceCursor& cursor) noexcept;
  PageAccess take(std::uint32_t reader) noexcept;
  static void pop_motion(PageTrace::Ring& ring, PageAccess& access) noexcept;
  void describe_page(TraceWord word, PageAccess& access) noexcept;
  PageAccess::Event event_of(TraceWord word) noexcept;

  PageTraces& traces_;
  const storage::PageFile& file_;
};

}  // namespace planetree::query
