#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "planetree/error.h"
#include "storage/file/file_layout.h"

namespace planetree::storage {

/// Which of a file's two headers to go by.
struct HeaderChoice {
  FileHeader header;  ///< its magic and hash are right; nothing else has been looked at
  bool copy_damaged;  ///< the other copy is absent, damaged or different
};

/// Takes the leading header if it is whole, else the trailing one, so that
/// damage to either does not lose the file.
///
/// leading       the file's first bytes: min(kHeaderBytes, actual_bytes) of them.
/// trailing      the file's last kHeaderBytes bytes, or none if it is too short to have both.
/// actual_bytes  the file's length.
/// errors        kNotPlanetree, which says what was found instead; kTruncated, kUnsupported or
///               kDamaged where it is a .ptree file, but neither header is whole.
Result<HeaderChoice> choose_header(std::span<const std::byte> leading,
                                   std::span<const std::byte> trailing,
                                   std::uint64_t actual_bytes) noexcept;

}  // namespace planetree::storage
