#include "query/file/field_loading.h"

#include <array>
#include <memory>
#include <new>

#include "octree/field/field_page.h"
#include "query/file/page_decoding.h"

namespace planetree::query {
namespace {

// Takes the points of a field in their order, and keeps every n-th along each axis.
class PointSieve {
 public:
  PointSieve(const octree::FieldShape& shape, std::uint32_t n, std::span<octree::FieldPoint> kept)
      : shape_(shape), n_(n), kept_(kept) {}

  void take(std::span<const octree::FieldPoint> points) {
    for (const octree::FieldPoint& point : points) {
      if (at_[0] % n_ == 0 && at_[1] % n_ == 0 && at_[2] % n_ == 0) kept_[count_++] = point;
      for (unsigned axis = 0; axis < 3 && ++at_[axis] == shape_.size[axis]; ++axis) at_[axis] = 0;
    }
  }

 private:
  const octree::FieldShape& shape_;
  const std::uint32_t n_;
  const std::span<octree::FieldPoint> kept_;
  std::array<std::uint32_t, 3> at_{};  // of the next point
  std::size_t count_ = 0;
};

}  // namespace

Result<LoadedField> load_field(const storage::PageFile& file, std::uint32_t n,
                               std::span<std::byte> memory) {
  const storage::FileHeader& header = file.header();
  LoadedField field;
  if (header.model.field_page_count == 0) return field;
  const octree::FieldShape shape = field_shape(header.model);
  const std::size_t in_page = octree::points_per_field_page(header.page_bytes);
  const std::unique_ptr<std::byte[]> stored(new (std::nothrow) std::byte[header.max_stored_bytes]);
  const std::unique_ptr<std::byte[]> raw(new (std::nothrow) std::byte[header.max_raw_bytes]);
  const std::unique_ptr<octree::FieldPoint[]> decoded(new (std::nothrow)
                                                          octree::FieldPoint[in_page]);
  if (!stored || !raw || !decoded)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory to read the coarse field; free some and try again");
  const std::span<octree::FieldPoint> points(reinterpret_cast<octree::FieldPoint*>(memory.data()),
                                             shape.thinned(n).count());
  PointSieve sieve(shape, n, points);
  for (std::uint32_t page = header.first_field_page(); page < header.first_attribute_page();
       ++page) {
    const auto entry = file.entry(page);
    const std::span<std::byte> bytes(raw.get(), entry ? entry->raw_bytes : 0);
    const std::span<octree::FieldPoint> of_page(decoded.get(), field_points(header, page));
    if (!entry || !file.read_page(page, {stored.get(), header.max_stored_bytes}, bytes) ||
        !octree::decode_field_page(bytes, page_info(header, *entry, page), of_page)) {
      field.is_damaged = true;
      return field;
    }
    sieve.take(of_page);
  }
  field.points = points;
  return field;
}

}  // namespace planetree::query
