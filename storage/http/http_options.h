#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace planetree::storage {

/// Limits of the requests for one read. A read that reaches them fails; a later one may succeed.
struct HttpLimits {
  unsigned attempts = 4;                         ///< of each request, at least 1
  std::chrono::milliseconds first_pause{200};    ///< before the second attempt; then it doubles
  std::chrono::milliseconds max_connect{4'000};  ///< until there is a connection
  std::chrono::milliseconds max_stall{5'000};    ///< without any byte; whole seconds
  std::chrono::milliseconds max_total{15'000};   ///< of all attempts, pauses included
};

/// How to read an object that a server has.
struct HttpOptions {
  /// Directory of the cluster file. Empty: there is none.
  std::filesystem::path cache_directory{};
  std::uint64_t cache_bytes = std::uint64_t{1} << 30;  ///< maximum length of the cluster file
  HttpLimits limits{};
  std::size_t clusters = 64;  ///< kept in memory, at least ClusterMemory::kMinSlots
};

}  // namespace planetree::storage
