#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "planetree/error.h"

namespace planetree::storage {

/// Compresses records of one size by LZ4. The first bytes of all records lie side by side, then the
/// second bytes and so on, because bytes at the same place in a record are alike.
///
/// records  whole records, at least one; less than 1 GiB.
std::vector<std::byte> pack_records(std::span<const std::byte> records, std::size_t record_bytes);

/// Unpacks records.
///
/// packed   of pack_records(); any bytes are allowed.
/// records  receives all records that were packed together.
/// errors   kDamaged: these are not as many records.
Result<void> unpack_records(std::span<const std::byte> packed, std::size_t record_bytes,
                            std::span<std::byte> records);

}  // namespace planetree::storage
