#include "octree/builder/mesh/stream/text_records.h"

#include <algorithm>

namespace planetree::octree {
namespace {

/// No record of a text is shorter than the line "vt 0".
std::uint64_t max_bytes(const MeshFile& file, std::size_t record_bytes) {
  constexpr std::uint64_t kLineBytes = 5;
  return (file.size_bytes() / kLineBytes + 1) * record_bytes;
}

}  // namespace

TextRecords::TextRecords(const MeshFile& file, std::size_t record_bytes, std::uint64_t held_bytes,
                         MeshScratch& scratch)
    : record_bytes_(record_bytes),
      file_(scratch, std::min(held_bytes, max_bytes(file, record_bytes))) {}

Result<void> TextRecords::finish() {
  const auto put = file_.spill().append(last_);
  last_.clear();
  if (!put) return put.error();
  return {};
}

Result<void> TextRecords::read(std::uint64_t first, std::span<std::byte> out) {
  return file_.spill().read(first * record_bytes_, out);
}

}  // namespace planetree::octree
