#include "storage/spill/record_packing.h"

#include <lz4.h>

#include <cassert>
#include <cstring>

namespace planetree::storage {
namespace {

using Bytes = std::vector<std::byte>;

Bytes split(std::span<const std::byte> records, std::size_t record_bytes) {
  const std::size_t count = records.size() / record_bytes;
  Bytes planes(records.size());
  std::byte* to = planes.data();
  for (std::size_t k = 0; k < record_bytes; ++k) {
    const std::byte* from = records.data() + k;
    for (std::size_t i = 0; i < count; ++i, from += record_bytes) *to++ = *from;
  }
  return planes;
}

void join(const Bytes& planes, std::size_t record_bytes, std::span<std::byte> records) {
  const std::size_t count = records.size() / record_bytes;
  const std::byte* from = planes.data();
  for (std::size_t k = 0; k < record_bytes; ++k) {
    std::byte* to = records.data() + k;
    for (std::size_t i = 0; i < count; ++i, to += record_bytes) *to = *from++;
  }
}

}  // namespace

// What LZ4 does not make shorter is left as it is, so that the length tells which of the two it is.
Bytes pack_records(std::span<const std::byte> records, std::size_t record_bytes) {
  assert(!records.empty() && records.size() < 1U << 30 && records.size() % record_bytes == 0);
  Bytes planes = split(records, record_bytes);
  Bytes packed(planes.size() - 1);
  const int length = LZ4_compress_default(
      reinterpret_cast<const char*>(planes.data()), reinterpret_cast<char*>(packed.data()),
      static_cast<int>(planes.size()), static_cast<int>(packed.size()));
  if (length <= 0) return planes;
  packed.resize(static_cast<std::size_t>(length));
  return packed;
}

Result<void> unpack_records(std::span<const std::byte> packed, std::size_t record_bytes,
                            std::span<std::byte> records) {
  assert(records.size() < 1U << 30 && records.size() % record_bytes == 0);
  Bytes planes(records.size());
  if (packed.size() == planes.size()) {
    std::memcpy(planes.data(), packed.data(), packed.size());
  } else {
    const int length =
        packed.size() < planes.size()
            ? LZ4_decompress_safe(reinterpret_cast<const char*>(packed.data()),
                                  reinterpret_cast<char*>(planes.data()),
                                  static_cast<int>(packed.size()), static_cast<int>(planes.size()))
            : -1;
    if (length < 0 || static_cast<std::size_t>(length) != planes.size())
      return make_error(ErrorCode::kDamaged, Error::kNowhere, Error::kNowhere,
                        "records cannot be unpacked; repeat the step that wrote them");
  }
  join(planes, record_bytes, records);
  return {};
}

}  // namespace planetree::storage
