#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "storage/system/file_calls.h"

namespace planetree::storage {

/// Free space on the device of a directory.
struct DeviceSpace {
  /// Device number, if the system reports one.
  std::optional<std::uint64_t> device;
  /// Bytes that a process without privileges can still write. Empty if the system does not report
  /// them; some file systems do not. Quotas and file size limits are not taken into account.
  std::optional<std::uint64_t> free_bytes;

  /// directory  should exist; otherwise both members are empty.
  /// calls      the system.
  static DeviceSpace of(const std::filesystem::path& directory,
                        FileCalls& calls = FileCalls::real()) noexcept;

  bool is_same_device(const DeviceSpace& other) const noexcept {
    return device.has_value() && device == other.device;
  }
};

}  // namespace planetree::storage
