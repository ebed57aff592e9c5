#include "octree/builder/mesh/ply_records.h"

#include <cinttypes>

#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::octree {

Result<void> PlyRecords::check_space(const PlyElement& element, std::uint64_t begin) const {
  const std::uint64_t record_bytes = element.min_record_bytes();
  const std::uint64_t space = file_.size_bytes() - begin;
  if (record_bytes == 0 || element.count <= space / record_bytes) return {};
  return make_error(ErrorCode::kBadInput, Error::kNowhere, begin,
                    "byte %" PRIu64 ": %" PRIu64 " records '%s' of %" PRIu64
                    " bytes or more do not fit in the %" PRIu64
                    " left: truncated or miscounted; copy or export it again",
                    begin, element.count, printable(element.name).c_str(), record_bytes, space);
}

Error PlyRecords::bad_record(const PlyElement& element, std::uint64_t record,
                             std::uint64_t offset) const {
  if (read_failed_) return window_.failure();
  return make_error(ErrorCode::kBadInput, Error::kNowhere, offset,
                    "byte %" PRIu64 ": record %" PRIu64 " of %" PRIu64
                    " '%s' has a bad list length or is cut off: truncated or damaged; copy or "
                    "export it again",
                    offset, record, element.count, printable(element.name).c_str());
}

bool PlyRecords::take_count(const PlyProperty& property, std::uint64_t& position,
                            std::uint64_t& count) {
  const std::uint64_t bytes = size_bytes(property.count_type);
  if (file_.size_bytes() - position < bytes) return false;
  const std::byte* const at = window_.at(position, bytes);
  read_failed_ = at == nullptr;
  if (read_failed_) return false;
  const std::int64_t length = load_integer(property.count_type, at, swap_);
  if (length < 0) return false;
  count = static_cast<std::uint64_t>(length);
  position += bytes;
  return true;
}

}  // namespace planetree::octree
