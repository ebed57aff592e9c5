#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "storage/system/file_calls.h"

namespace planetree::storage {

/// The room that a directory's device has.
struct DeviceSpace {
  /// Which device it is, as far as the system tells.
  std::optional<std::uint64_t> device;
  /// What a process without privileges may still fill; nothing where the system does not tell,
  /// as some file systems do not. Quotas and limits of file sizes are not seen.
  std::optional<std::uint64_t> free_bytes;

  /// directory  one that exists; else nothing is known of it.
  static DeviceSpace of(const std::filesystem::path& directory,
                        FileCalls& calls = FileCalls::real()) noexcept;

  bool is_same_device(const DeviceSpace& other) const noexcept {
    return device.has_value() && device == other.device;
  }
};

}  // namespace planetree::storage
