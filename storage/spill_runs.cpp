#include "storage/spill_runs.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

namespace planetree::storage {

Result<void> SpillRuns::add(std::vector<std::byte> records) {
  assert(record_bytes_ >= sizeof(SpillKey) && records.size() % record_bytes_ == 0);
  if (records.empty()) return {};
  Run run;
  run.size = records.size() / record_bytes_;
  {
    const std::lock_guard lock(adding_);
    if (records.size() <= held_bytes_) {
      held_bytes_ -= records.size();
      run.held = std::move(records);
    }
  }
  if (run.held.empty()) {
    const auto offset = file_.append(records);
    if (!offset) return offset.error();
    run.offset = *offset;
  }
  const std::lock_guard lock(adding_);
  size_ += run.size;
  runs_.push_back(std::move(run));
  return {};
}

SpillRuns::Cut SpillRuns::end() const {
  Cut cut;
  for (const Run& run : runs_) cut.push_back(run.size);
  return cut;
}

Result<void> SpillRuns::get(const Run& run, std::uint64_t from, std::span<std::byte> out) const {
  const std::uint64_t offset = from * record_bytes_;
  if (run.held.empty()) return file_.read(run.offset + offset, out);
  if (!out.empty()) std::memcpy(out.data(), run.held.data() + offset, out.size());
  return {};
}

Result<std::uint64_t> SpillRuns::find(const Run& run, const SpillKey& key) const {
  std::uint64_t first = 0, last = run.size;
  while (first < last) {
    const std::uint64_t middle = first + (last - first) / 2;
    SpillKey at;
    if (const auto got = get(run, middle, std::as_writable_bytes(std::span(&at, 1))); !got)
      return got.error();
    if (at < key)
      first = middle + 1;
    else
      last = middle;
  }
  return first;
}

Result<SpillRuns::Cut> SpillRuns::cut(const SpillKey& key) const {
  Cut cut;
  for (const Run& run : runs_) {
    const auto place = find(run, key);
    if (!place) return place.error();
    cut.push_back(*place);
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
