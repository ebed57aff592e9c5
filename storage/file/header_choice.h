#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "planetree/error.h"
#include "storage/file/file_layout.h"

namespace planetree::storage {

/// The header to use of the two in a file.
struct HeaderChoice {
  FileHeader header;  ///< magic and hash are correct; nothing else has been checked
  bool copy_damaged;  ///< the other header is absent, damaged or different
};

/// Chooses the leading header if its magic and hash are correct, otherwise the trailing one. So a
/// file stays readable after damage to one of them.
///
/// leading       first min(kHeaderBytes, actual_bytes) bytes of the file.
/// trailing      last kHeaderBytes bytes of the file; empty if it is too short to have both.
/// actual_bytes  length of the file.
/// errors        kNotPlanetree, which states what was found instead; kTruncated, kUnsupported or
///               kDamaged, if it is a .ptree file but neither header is usable.
Result<HeaderChoice> choose_header(std::span<const std::byte> leading,
                                   std::span<const std::byte> trailing,
                                   std::uint64_t actual_bytes) noexcept;

}  // namespace planetree::storage
