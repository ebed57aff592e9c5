#include "octree/builder/mesh/stream/corner_sort.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <span>

namespace planetree::octree {
namespace {

/// On its way to the vertices a record has the vertex within its part, and the corner's number. On
/// its way back it has the corner within its part, and the record of the vertex.
constexpr std::size_t kIndexBytes = sizeof(std::uint32_t);
constexpr std::size_t kByVertexBytes = kIndexBytes + sizeof(std::uint64_t);

constexpr std::size_t by_corner_bytes(std::size_t vertex_bytes) {
  return kIndexBytes + vertex_bytes;
}

Error changed_error() {
  return make_error(ErrorCode::kReadFailed, Error::kNowhere, Error::kNowhere,
                    "a temporary file is not what was written; check the device and the system's "
                    "log");
}

}  // namespace

// Half of the memory is for a part of the vertices or of the corners, a quarter for each
// distribution. Both distributions exist during match().
CornerSort::CornerSort(MeshRecords& vertices, MeshScratch& scratch, std::uint64_t memory_bytes)
    : vertices_(vertices),
      scratch_(scratch),
      record_bytes_(vertices.record_bytes()),
      buffer_bytes_(memory_bytes / 4) {
  constexpr std::uint64_t kMax = std::uint64_t{1} << 32;
  const std::uint64_t max_items =
      std::clamp<std::uint64_t>(memory_bytes / 2 / record_bytes_, 1, kMax);
  part_shift_ = static_cast<int>(std::bit_width(max_items)) - 1;
  by_vertex_file_.emplace(scratch);
  by_vertex_.emplace(kByVertexBytes, parts_of(vertices.count()), buffer_bytes_,
                     by_vertex_file_->spill());
}

std::uint64_t CornerSort::disk_bytes(std::uint64_t corners, bool float32,
                                     std::uint32_t attributes) {
  const std::size_t vertex_bytes =
      3 * (float32 ? sizeof(float) : sizeof(double)) + attribute_bytes(attributes);
  const std::uint64_t bytes = corners * (kByVertexBytes + by_corner_bytes(vertex_bytes));
  return bytes + bytes / 32;  // the links between the blocks of a bucket
}

Result<void> CornerSort::add(std::uint64_t vertex) {
  std::byte* const record = by_vertex_->add(static_cast<std::size_t>(vertex >> part_shift_));
  if (record == nullptr) return by_vertex_->failure();
  const auto position = static_cast<std::uint32_t>(vertex & part_mask());
  std::memcpy(record, &position, sizeof position);
  std::memcpy(record + kIndexBytes, &corner_count_, sizeof corner_count_);
  ++corner_count_;
  return {};
}

Result<void> CornerSort::match(
    const std::function<Result<void>(std::uint64_t, std::uint64_t)>& done) {
  by_corner_file_.emplace(scratch_);
  by_corner_.emplace(by_corner_bytes(record_bytes_), parts_of(corner_count_), buffer_bytes_,
                     by_corner_file_->spill());
  const std::size_t parts = by_vertex_->bucket_count();
  for (std::size_t part = 0; part < parts; ++part) {
    if (!by_vertex_->is_empty(part))
      if (const auto matched = match_part(part); !matched) return matched;
    if (const auto told = done(part + 1, parts); !told) return told;
  }
  by_vertex_.reset();
  by_vertex_file_.reset();
  return {};
}

Result<void> CornerSort::match_part(std::size_t part) {
  const std::uint64_t first = std::uint64_t{part} << part_shift_;
  const std::uint64_t count = std::min(std::uint64_t{1} << part_shift_, vertices_.count() - first);
  records_.resize(static_cast<std::size_t>(count) * record_bytes_);
  if (const auto read = vertices_.read(first, records_); !read) return read;
  return by_vertex_->each_block(part, [this](std::span<const std::byte> records) -> Result<void> {
    for (; !records.empty(); records = records.subspan(kByVertexBytes))
      if (const auto filled = fill(records.data()); !filled) return filled;
    return {};
  });
}

Result<void> CornerSort::fill(const std::byte* corner) {
  std::uint32_t position = 0;
  std::uint64_t number = 0;
  std::memcpy(&position, corner, sizeof position);
  std::memcpy(&number, corner + kIndexBytes, sizeof number);
  const std::size_t from = std::size_t{position} * record_bytes_;
  if (from >= records_.size() || number >= corner_count_) return changed_error();
  std::byte* const record = by_corner_->add(static_cast<std::size_t>(number >> part_shift_));
  if (record == nullptr) return by_corner_->failure();
  position = static_cast<std::uint32_t>(number & part_mask());
  std::memcpy(record, &position, sizeof position);
  std::memcpy(record + kIndexBytes, records_.data() + from, record_bytes_);
  return {};
}

bool CornerSort::load(std::uint64_t part) {
  const std::uint64_t first = part << part_shift_;
  const std::uint64_t count = std::min(std::uint64_t{1} << part_shift_, corner_count_ - first);
  records_.assign(static_cast<std::size_t>(count) * record_bytes_, std::byte{0});
  loaded_ = ~std::uint64_t{0};
  const std::size_t record_bytes = by_corner_bytes(record_bytes_);
  const auto positioned = by_corner_->each_block(
      static_cast<std::size_t>(part), [&](std::span<const std::byte> records) -> Result<void> {
        for (; !records.empty(); records = records.subspan(record_bytes)) {
          std::uint32_t position = 0;
          std::memcpy(&position, records.data(), sizeof position);
          if (position >= count) return changed_error();
          std::memcpy(records_.data() + std::size_t{position} * record_bytes_,
                      records.data() + kIndexBytes, record_bytes_);
        }
        return {};
      });
  if (positioned) {
    loaded_ = part;
    return true;
  }
  failure_ = positioned.error();
  return false;
}

const std::byte* CornerSort::missing(std::uint64_t corner) {
  if (corner >= corner_count_)
    failure_ = make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                          "the mesh has changed while it was read; leave it alone and try again");
  return nullptr;
}

}  // namespace planetree::octree
