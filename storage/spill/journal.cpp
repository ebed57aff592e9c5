#include "storage/spill/journal.h"

#include <cstring>
#include <vector>

#include "storage/file/checksum.h"

namespace planetree::storage {
namespace {

/// Head of a record, followed by the payload.
struct RecordHead {
  std::uint64_t check = 0;  // hash of all bytes after it, seeded with the record's offset
  std::uint64_t payload_bytes = 0;
  std::uint32_t kind = 0;
  std::uint32_t reserved = 0;
};

std::uint64_t check_of(std::span<const std::byte> record, std::uint64_t offset) noexcept {
  return hash64(record.subspan(sizeof(RecordHead::check)), offset);
}

}  // namespace

Result<void> Journal::replay(const Take& take) {
  const auto file_bytes = file_.size_bytes();
  if (!file_bytes) return file_bytes.error();
  std::vector<std::byte> record;
  while (*file_bytes - size_bytes_ >= sizeof(RecordHead)) {
    RecordHead head;
    const auto bytes = std::as_writable_bytes(std::span(&head, 1));
    if (const auto read = file_.read_at(size_bytes_, bytes); !read) return read;
    if (head.payload_bytes > *file_bytes - size_bytes_ - sizeof head) break;
    record.resize(sizeof head + head.payload_bytes);
    if (const auto read = file_.read_at(size_bytes_, record); !read) return read;
    if (check_of(record, size_bytes_) != head.check) break;
    if (!take(head.kind, std::span(record).subspan(sizeof head))) break;
    size_bytes_ += record.size();
  }
  // Remaining bytes must be removed: after a new record they could look like a valid one.
  if (size_bytes_ < *file_bytes) return file_.truncate(size_bytes_);
  return {};
}

Result<void> Journal::append(std::uint32_t kind, std::span<const std::byte> payload) {
  const std::lock_guard lock(mutex_);
  if (failure_) return *failure_;
  RecordHead head{0, payload.size(), kind, 0};
  std::vector<std::byte> record(sizeof head + payload.size());
  std::memcpy(record.data(), &head, sizeof head);
  if (!payload.empty()) std::memcpy(record.data() + sizeof head, payload.data(), payload.size());
  head.check = check_of(record, size_bytes_);
  std::memcpy(record.data(), &head, sizeof head);
  auto written = file_.write_at(size_bytes_, record);
  if (written) written = file_.sync_data();
  if (written)
    size_bytes_ += record.size();
  else
    failure_ = written.error();
  return written;
}

}  // namespace planetree::storage
