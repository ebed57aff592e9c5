#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "planetree/error.h"
#include "storage/file/file_layout.h"

/// Errors of the header, and tests of its fields.
namespace planetree::storage {

inline Error damaged(std::uint64_t page, std::uint64_t offset, const char* cause) noexcept {
  return make_error(ErrorCode::kDamaged, page, offset,
                    "%s; restore the file from a copy or build it again", cause);
}

inline Error bad_header(std::size_t offset, const char* cause) noexcept {
  return damaged(Error::kNowhere, offset, cause);
}

inline Error bad_model(std::size_t offset, const char* cause) noexcept {
  return bad_header(offsetof(FileHeader, model) + offset, cause);
}

inline bool all_zero(std::span<const std::uint8_t> bytes) noexcept {
  return std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t byte) { return byte == 0; });
}

inline bool all_finite(std::span<const double> values) noexcept {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

}  // namespace planetree::storage
