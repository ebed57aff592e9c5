#include "storage/spill/spill_runs.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

#include "storage/spill/record_packing.h"

namespace planetree::storage {

Result<SpillRuns::Extent> SpillRuns::add(std::vector<std::byte> records) {
  assert(record_bytes_ >= sizeof(SpillKey) && records.size() % record_bytes_ == 0);
  if (records.empty()) return Extent{};
  Run run;
  run.extent.size = records.size() / record_bytes_;
  bool held = false;
  {
    const std::lock_guard lock(adding_);
    held = records.size() <= held_bytes_;
    if (held) held_bytes_ -= records.size();
  }
  if (held) {
    run.held = std::move(records);
  } else {
    if (const auto written = write(std::move(records), run.extent); !written)
      return written.error();
  }
  const std::lock_guard lock(adding_);
  size_ += run.extent.size;
  return runs_.emplace_back(std::move(run)).extent;
}

// The packed groups take the place of the records, because they are no longer.
void SpillRuns::pack(std::vector<std::byte>& records, Extent& extent) const {
  const std::size_t step = kMarkRecords * record_bytes_;
  std::size_t end = 0;
  for (std::size_t at = 0; at < records.size(); at += step) {
    const auto group = std::span(records).subspan(at, std::min(step, records.size() - at));
    const std::vector<std::byte> packed = pack_records(group, record_bytes_);
    std::memcpy(records.data() + end, packed.data(), packed.size());
    end += packed.size();
    extent.group_ends.push_back(end);
  }
  records.resize(end);
}

Result<void> SpillRuns::write(std::vector<std::byte> records, Extent& extent) {
  extent.marks = marks_of(records);
  if (packing_ == Packing::kGroups) pack(records, extent);
  const auto offset = file_.append(records);
  if (!offset) return offset.error();
  extent.offset = *offset;
  return {};
}

void SpillRuns::add_extent(Extent extent) {
  if (extent.size == 0) return;
  assert(extent.marks.size() == mark_count(extent.size));
  const std::lock_guard lock(adding_);
  size_ += extent.size;
  runs_.push_back({std::move(extent), {}});
}

std::vector<SpillRuns::Extent> SpillRuns::extents() const {
  std::vector<Extent> extents;
  for (const Run& run : runs_) {
    assert(run.held.empty());
    extents.push_back(run.extent);
  }
  return extents;
}

SpillRuns::Cut SpillRuns::end() const {
  Cut cut;
  for (const Run& run : runs_) cut.push_back(run.extent.size);
  return cut;
}

Result<void> SpillRuns::get(const Run& run, std::uint64_t from, std::span<std::byte> out) const {
  const std::uint64_t offset = from * record_bytes_;
  if (!run.extent.group_ends.empty()) return get_packed(run.extent, from, out);
  if (run.held.empty()) return file_.read(run.extent.offset + offset, out);
  if (!out.empty()) std::memcpy(out.data(), run.held.data() + offset, out.size());
  return {};
}

// Reads the groups that have the records by one call, then unpacks one after the other. `out` may
// end within a record.
Result<void> SpillRuns::get_packed(const Extent& extent, std::uint64_t from,
                                   std::span<std::byte> out) const {
  if (out.empty()) return {};
  const auto start_of = [&](std::uint64_t group) {
    return group == 0 ? 0 : extent.group_ends[static_cast<std::size_t>(group - 1)];
  };
  const std::uint64_t records = (out.size() - 1) / record_bytes_ + 1;
  const std::uint64_t first = from / kMarkRecords, last = (from + records - 1) / kMarkRecords;
  std::vector<std::byte> packed(static_cast<std::size_t>(start_of(last + 1) - start_of(first)));
  if (const auto read = file_.read(extent.offset + start_of(first), packed); !read) return read;
  std::vector<std::byte> group;
  auto skipped = static_cast<std::size_t>((from - first * kMarkRecords) * record_bytes_);
  for (std::uint64_t at = first; at <= last; ++at) {
    const std::uint64_t in_group = std::min(kMarkRecords, extent.size - at * kMarkRecords);
    group.resize(static_cast<std::size_t>(in_group) * record_bytes_);
    const auto bytes =
        std::span(packed).subspan(static_cast<std::size_t>(start_of(at) - start_of(first)),
                                  static_cast<std::size_t>(start_of(at + 1) - start_of(at)));
    if (const auto unpacked = unpack_records(bytes, record_bytes_, group); !unpacked)
      return unpacked;
    const std::size_t some = std::min(group.size() - skipped, out.size());
    std::memcpy(out.data(), group.data() + skipped, some);
    out = out.subspan(some);
    skipped = 0;
  }
  return {};
}

std::vector<std::uint64_t> SpillRuns::marks_of(std::span<const std::byte> records) const {
  std::vector<std::uint64_t> marks;
  const std::size_t step = kMarkRecords * record_bytes_;
  marks.reserve(mark_count(records.size() / record_bytes_));
  for (std::size_t at = 0; at < records.size(); at += step)
    std::memcpy(&marks.emplace_back(), records.data() + at, sizeof marks.back());
  return marks;
}

// The marks limit the search to the records between two marks, or to more if many records have the
// same first half of the key.
Result<std::uint64_t> SpillRuns::find(const Run& run, const SpillKey& key) const {
  const std::vector<std::uint64_t>& marks = run.extent.marks;
  const auto [same, after] = std::equal_range(marks.begin(), marks.end(), key.first);
  const auto records_before = [&](auto mark) {
    return static_cast<std::uint64_t>(mark - marks.begin()) * kMarkRecords;
  };
  const std::uint64_t first = same == marks.begin() ? 0 : records_before(same - 1);
  const std::uint64_t last = after == marks.end() ? run.extent.size : records_before(after);
  return find_within(run, first, last, key);
}

Result<std::uint64_t> SpillRuns::find_within(const Run& run, std::uint64_t first,
                                             std::uint64_t last, const SpillKey& key) const {
  const std::uint64_t at_once = run.held.empty() ? 2 * kMarkRecords : 0;
  while (last - first > at_once) {
    const std::uint64_t middle = first + (last - first) / 2;
    SpillKey at;
    if (const auto got = get(run, middle, std::as_writable_bytes(std::span(&at, 1))); !got)
      return got.error();
    if (at < key)
      first = middle + 1;
    else
      last = middle;
  }
  std::vector<std::byte> records((last - first) * record_bytes_);
  if (const auto got = get(run, first, records); !got) return got.error();
  const std::byte* at = records.data();
  for (SpillKey found; first < last; ++first, at += record_bytes_) {
    std::memcpy(&found, at, sizeof found);
    if (!(found < key)) break;
  }
  return first;
}

Result<SpillRuns::Cut> SpillRuns::cut(const SpillKey& key) const {
  Cut cut;
  for (const Run& run : runs_) {
    const auto extent = find(run, key);
    if (!extent) return extent.error();
    cut.push_back(*extent);
  }
  return cut;
}

std::uint64_t SpillRuns::count(const Cut& from, const Cut& to) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < from.size(); ++i) sum += to[i] - from[i];
  return sum;
}

Result<std::vector<std::byte>> SpillRuns::read(const Cut& from, const Cut& to) const {
  std::vector<std::byte> records(count(from, to) * record_bytes_);
  std::span<std::byte> left = records;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    const std::size_t bytes = (to[i] - from[i]) * record_bytes_;
    if (bytes == 0) continue;
    if (const auto got = get(runs_[i], from[i], left.first(bytes)); !got) return got.error();
    left = left.subspan(bytes);
  }
  return records;
}

}  // namespace planetree::storage
