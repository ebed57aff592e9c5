#include "tools/points/raw_points.h"

#include <bit>
#include <cstddef>

namespace planetree::tools {

static_assert(std::endian::native == std::endian::little && sizeof(Vec3) == 3 * sizeof(double),
              "the file's bytes are read in place");

Result<std::size_t> RawPoints::read(std::span<Vec3> points) {
  if (odd_bytes_ == 0) {
    const auto bytes = file_.read(std::as_writable_bytes(points));
    if (!bytes) return bytes.error();
    const std::size_t count = *bytes / sizeof(Vec3);
    odd_bytes_ = *bytes % sizeof(Vec3);
    offset_ += count * sizeof(Vec3);
    if (count > 0 || odd_bytes_ == 0) return count;
  }
  return make_error(ErrorCode::kBadInput, Error::kNowhere, offset_,
                    "the file ends %zu bytes into a point of 24 bytes; write whole points",
                    odd_bytes_);
}

}  // namespace planetree::tools
