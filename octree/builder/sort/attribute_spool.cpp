#include "octree/builder/sort/attribute_spool.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

namespace planetree::octree {

std::uint64_t SpooledAttributes::block_records(std::uint64_t block) const {
  return std::min(kBlockRecords, count - block * kBlockRecords);
}

Result<void> SpooledAttributes::read(const storage::SpillFile& file, std::uint64_t first,
                                     std::span<std::byte> out) const {
  assert(first + out.size() / record_bytes <= count);
  while (!out.empty()) {
    const std::uint64_t block = first / kBlockRecords;
    const std::uint64_t within = first % kBlockRecords;
    const auto records = static_cast<std::size_t>(
        std::min<std::uint64_t>(block_records(block) - within, out.size() / record_bytes));
    const auto part = out.first(records * record_bytes);
    const auto offset = offsets[static_cast<std::size_t>(block)] + within * record_bytes;
    if (const auto read = file.read(offset, part); !read) return read;
    out = out.subspan(part.size());
    first += records;
  }
  return {};
}

AttributeSpool::AttributeSpool(AttributeShape shape, TriangleSink& next, storage::SpillFile& file)
    : shape_(shape),
      next_(next),
      file_(file),
      block_(SpooledAttributes::kBlockRecords * shape.extra_bytes()) {
  assert(shape.extra_bytes() > 0);
  spooled_.record_bytes = shape.extra_bytes();
}

// Adds a record of zeros and returns it.
std::byte* AttributeSpool::add() {
  if (block_bytes_ == block_.size())
    if (const auto stored = store_block(); stored_) stored_ = stored;
  std::byte* const record = block_.data() + block_bytes_;
  std::memset(record, 0, shape_.extra_bytes());
  block_bytes_ += shape_.extra_bytes();
  ++spooled_.count;
  return record;
}

Result<void> AttributeSpool::attributes(const TriangleAttributes& attributes) {
  std::byte* to = add();
  const auto put = [&to](const auto& value) {
    std::memcpy(to, &value, sizeof value);
    to += sizeof value;
  };
  if (shape_.has_colors()) put(attributes.colors);
  if (shape_.has_uvs()) put(attributes.uvs);
  if (shape_.has_values()) put(attributes.value);
  return stored_;
}

void AttributeSpool::skipped(std::uint64_t first_index, std::uint64_t count,
                             const SkippedRecord& why) {
  for (std::uint64_t i = 0; i < count && stored_; ++i) add();
  next_.skipped(first_index, count, why);
}

Result<void> AttributeSpool::progress(std::uint64_t bytes_done, std::uint64_t bytes_total) {
  return stored_ ? next_.progress(bytes_done, bytes_total) : stored_;
}

Result<void> AttributeSpool::store_block() {
  const auto offset = file_.append(std::span(block_).first(block_bytes_));
  block_bytes_ = 0;
  if (!offset) return offset.error();
  spooled_.offsets.push_back(*offset);
  return {};
}

Result<SpooledAttributes> AttributeSpool::finish() {
  if (stored_ && block_bytes_ > 0) stored_ = store_block();
  if (!stored_) return stored_.error();
  return std::move(spooled_);
}

}  // namespace planetree::octree
