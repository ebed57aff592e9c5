#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

#include "planetree/error.h"
#include "storage/file/checksum.h"
#include "storage/http/cluster_memory.h"
#include "storage/system/file_handle.h"

namespace planetree::storage {

/// Clusters of objects in a file of this machine, which later processes find again. Any number of
/// objects share the file. It never grows beyond its limit.
///
/// The file is an array of slots: a head and the bytes of one cluster. A cluster has its place in
/// one of kWays slots, which follow from its key. The head has the key and a hash of the bytes, and
/// is written after them. So bytes that a crash cut short, or that two processes wrote over each
/// other, do not match their head and count as absent. Nothing is locked or made durable.
///
/// threads  any number at once, and of any number of processes
class ClusterFile {
 public:
  static constexpr std::uint64_t kWays = 4;
  static constexpr std::uint64_t kSlotBytes = 4096 + kClusterBytes;
  static constexpr std::uint64_t kMinBytes = kWays * kSlotBytes;

  /// Opens the file in a directory, or creates both. Cuts the file if it exceeds the limit.
  ///
  /// max_bytes  at least kMinBytes
  /// calls      the system; must outlive this
  /// errors     kBadArgument: the limit is too small; those of file_error()
  static Result<std::unique_ptr<ClusterFile>> open(const std::filesystem::path& directory,
                                                   std::uint64_t max_bytes,
                                                   FileCalls& calls = FileCalls::real());

  /// Fills `out` with a cluster of an object. Returns false if the file does not have it whole.
  bool read(const Hash128& object, std::uint64_t cluster, std::span<std::byte> out) const noexcept;
  /// Keeps a cluster, in place of another one if need be. A failure is no error: the cluster is
  /// then absent.
  void write(const Hash128& object, std::uint64_t cluster,
             std::span<const std::byte> bytes) const noexcept;
  /// Removes a cluster.
  void forget(const Hash128& object, std::uint64_t cluster) const noexcept;

 private:
  struct Head;

  ClusterFile(FileHandle file, std::uint64_t slots) noexcept;
  std::uint64_t first_slot(const Hash128& object, std::uint64_t cluster) const noexcept;
  bool read_head(std::uint64_t slot, Head& head) const noexcept;
  std::uint64_t find(const Hash128& object, std::uint64_t cluster, Head& head) const noexcept;

  const FileHandle file_;
  const std::uint64_t slots_;  // a multiple of kWays
};

}  // namespace planetree::storage
