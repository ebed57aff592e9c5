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

/// Whether this program reads files of a version: those of its own major version.
inline bool is_known_version(std::uint16_t version) noexcept {
  return version / 256 == kFormatVersion / 256;
}

/// Versions before 1.0 were counted from 1 on.
inline Error unknown_version(std::uint16_t version) noexcept {
  const int major = version / 256, minor = version % 256;
  return make_error(ErrorCode::kUnsupported, Error::kNowhere, offsetof(FileHeader, version),
                    major == 0
                        ? "the file has format version %d, from before 1.0, and this program "
                          "reads version 1; build the file again"
                        : "the file has format version %d.%d and this program reads version "
                          "1; update planetree or build the file again",
                    major == 0 ? minor : major, minor);
}

inline bool all_zero(std::span<const std::uint8_t> bytes) noexcept {
  return std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t byte) { return byte == 0; });
}

inline bool all_finite(std::span<const double> values) noexcept {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

}  // namespace planetree::storage
