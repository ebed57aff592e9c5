#include "query/serve/trace_decoder.h"

#include <bit>
#include <limits>

#include "octree/geometry/octcode.h"

namespace planetree::query {
namespace {

using Event = PageAccess::Event;
using Query = PageAccess::Query;

bool is_of_fetch_thread(Query query) { return query == Query::kFetch || query == Query::kPrefetch; }

PageAccess::Section section_of(const storage::FileHeader& header, std::uint32_t page) {
  return page < header.first_cap_page()         ? PageAccess::Section::kTree
         : page < header.first_field_page()     ? PageAccess::Section::kCaps
         : page < header.first_attribute_page() ? PageAccess::Section::kField
         : page < header.first_mask_page()      ? PageAccess::Section::kAttributes
                                                : PageAccess::Section::kMask;
}

}  // namespace

std::size_t TraceDecoder::decode(std::span<PageAccess> accesses) noexcept {
  constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
  const auto readers = static_cast<std::uint32_t>(traces_.of_readers.size());
  std::size_t count = 0;
  while (count < accesses.size()) {
    // The records of the oldest trace go on until another one is older.
    std::uint32_t oldest = readers;
    std::uint64_t time = kNever, next_time = kNever;
    for (std::uint32_t reader = 0; reader < readers; ++reader) {
      if (!look(reader)) continue;
      const std::uint64_t at = traces_.cursors[reader].time;
      if (oldest == readers || at < time) {
        next_time = time;
        time = at;
        oldest = reader;
      } else if (at < next_time) {
        next_time = at;
      }
    }
    if (oldest == readers) break;
    while (count < accesses.size() && look(oldest) && traces_.cursors[oldest].time <= next_time)
      accesses[count++] = take(oldest);
  }
  return count;
}

// Whether a trace has a record. Takes the words before it, which are for the cursor.
bool TraceDecoder::look(std::uint32_t reader) noexcept {
  TraceCursor& cursor = traces_.cursors[reader];
  PageTrace::Ring& ring = traces_.of_readers[reader].ring();
  while (!cursor.has_next && ring.pop(std::span(&cursor.next.bits, 1)) == 1)
    cursor.has_next = is_record(cursor);
  return cursor.has_next;
}

bool TraceDecoder::is_record(TraceCursor& cursor) noexcept {
  switch (cursor.next.event()) {
    case TraceEvent::kTime:
      cursor.time = cursor.next.value();
      return false;
    case TraceEvent::kNumber:
      cursor.number = cursor.next.value();
      return false;
    case TraceEvent::kBound:
      return false;
    default:
      return true;
  }
}

PageAccess TraceDecoder::take(std::uint32_t reader) noexcept {
  TraceCursor& cursor = traces_.cursors[reader];
  const TraceWord word = cursor.next;
  cursor.has_next = false;
  cursor.number = word.number(cursor.number);
  PageAccess access;
  access.time_ns = cursor.time;
  access.query = cursor.number;
  access.probe = reader;
  access.query_kind = word.query();
  access.in_batch = word.in_batch();
  access.waits = word.waits();
  if (word.event() == TraceEvent::kMotion) {
    access.event = Event::kMotion;
    pop_motion(traces_.of_readers[reader].ring(), access);
  } else if (word.event() == TraceEvent::kDegraded) {
    access.event = Event::kDegraded;
    access.width = word.real();
  } else {
    describe_page(word, access);
  }
  return access;
}

void TraceDecoder::pop_motion(PageTrace::Ring& ring, PageAccess& access) noexcept {
  for (double* const to : {&access.position.x, &access.position.y, &access.position.z,
                           &access.velocity.x, &access.velocity.y, &access.velocity.z}) {
    std::uint64_t bits = 0;
    ring.pop(std::span(&bits, 1));
    *to = std::bit_cast<double>(bits);
  }
}

void TraceDecoder::describe_page(TraceWord word, PageAccess& access) noexcept {
  storage::PageEntry entry{};
  if (const auto found = file_.entry(word.page())) entry = *found;
  access.page = word.page();
  access.octcode = entry.octcode;
  access.level = static_cast<std::uint8_t>(octree::cell_of_octcode(entry.octcode).level);
  access.stored_bytes = static_cast<std::uint32_t>(entry.stored_bytes);
  access.section = section_of(file_.header(), word.page());
  access.event = event_of(word);
  access.needed = word.flag() && word.event() != TraceEvent::kInstalled;
  access.is_upper = word.flag() && word.event() == TraceEvent::kInstalled;
}

// Returns what happened to a page, and updates its state.
Event TraceDecoder::event_of(TraceWord word) noexcept {
  std::uint8_t& state = traces_.states_of_pages[word.page()];
  const bool is_prefetch = word.query() == Query::kPrefetch;
  const bool was_unused = (state & kUnused) != 0, was_in_flight = (state & kInFlight) != 0;
  switch (word.event()) {
    case TraceEvent::kHit:
      if (is_of_fetch_thread(word.query())) return Event::kHit;
      state = 0;
      return was_unused ? Event::kPrefetched : Event::kHit;
    case TraceEvent::kMissed:
      return was_in_flight ? Event::kLate : Event::kMissed;
    case TraceEvent::kFetched:
      if (is_prefetch) state |= kInFlight;
      return Event::kFetched;
    case TraceEvent::kInstalled:
      state = is_prefetch ? kUnused : 0;
      return Event::kInstalled;
    default:
      state = 0;
      return was_unused ? Event::kEvictedUnused : Event::kEvicted;
  }
}

}  // namespace planetree::query
