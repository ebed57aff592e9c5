#include "query/file/field_loading.h"

#include <memory>
#include <new>

#include "octree/field/field_page.h"
#include "query/file/page_decoding.h"

namespace planetree::query {

Result<LoadedField> load_field(const storage::PageFile& file, std::span<std::byte> memory) {
  const storage::FileHeader& header = file.header();
  LoadedField field;
  if (header.model.field_page_count == 0) return field;
  const std::unique_ptr<std::byte[]> stored(new (std::nothrow) std::byte[header.max_stored_bytes]);
  const std::unique_ptr<std::byte[]> raw(new (std::nothrow) std::byte[header.max_raw_bytes]);
  if (!stored || !raw)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory to read the coarse field; free some and try again");
  const std::span<octree::FieldPoint> points(reinterpret_cast<octree::FieldPoint*>(memory.data()),
                                             field_shape(header.model).count());
  std::size_t read = 0;
  for (std::uint32_t page = header.first_field_page(); page < header.first_attribute_page();
       ++page) {
    const storage::PageEntry& entry = file.entries()[page];
    const std::span<std::byte> bytes(raw.get(), entry.raw_bytes);
    const std::size_t count = field_points(header, page);
    if (!file.read_page(page, {stored.get(), header.max_stored_bytes}, bytes) ||
        !octree::decode_field_page(bytes, page_info(header, entry, page),
                                   points.subspan(read, count))) {
      field.is_damaged = true;
      return field;
    }
    read += count;
  }
  field.points = points;
  return field;
}

}  // namespace planetree::query
