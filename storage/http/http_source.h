#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "planetree/error.h"
#include "storage/http/cluster_file.h"
#include "storage/http/cluster_memory.h"
#include "storage/http/http_options.h"
#include "storage/http/object_identity.h"
#include "storage/http/range_client.h"
#include "storage/system/byte_source.h"

namespace planetree::storage {

/// An object that a server has, read by ranges. Reads whole clusters: one request for neighbours,
/// and requests at once for others. While it is read from front to back, a request gets up to
/// kMaxRunClusters.
///
/// If the server has another object later, every read of what is not in memory fails.
///
/// memory   HttpOptions::clusters, and about 64 KiB for each connection
/// threads  any number at once
class HttpSource final : public ByteSource {
 public:
  /// Bytes of the first request.
  static constexpr std::uint64_t kHeadBytes = 2 * kClusterBytes;
  /// Maximum number of clusters of one request.
  static constexpr std::uint64_t kMaxRunClusters = 4;

  /// Sends the first request.
  ///
  /// url     of HTTP
  /// errors  those of RangeClient::open() and ClusterFile::open(); kNoMemory
  static Result<std::unique_ptr<ByteSource>> open(const std::string& url,
                                                  const HttpOptions& options);
  /// What memory_bytes() returns of a source that is opened with these options.
  static std::uint64_t memory_bytes(const HttpOptions& options) noexcept;

  std::string_view name() const noexcept override { return name_; }
  bool is_remote() const noexcept override { return true; }
  std::uint64_t size_bytes() const noexcept override { return identity_.size_bytes; }
  std::uint64_t memory_bytes() const noexcept override;
  SourceStats stats() const noexcept override;

  Result<void> read_at(std::uint64_t offset, std::span<std::byte> out,
                       const char* what) const noexcept override;
  /// Copies what is in memory. Never sends a request.
  bool try_read(std::uint64_t offset, std::span<std::byte> out,
                const ReadLimits& terms) const noexcept override;
  void prefetch(std::span<const ByteRange> ranges) const noexcept override;
  void prefetch_within(std::span<const ByteRange> ranges,
                       std::chrono::milliseconds max_time) const noexcept override;
  bool is_here(const ByteRange& range) const noexcept override;
  bool forget(const ByteRange& range) const noexcept override;

 private:
  using Claim = ClusterMemory::Claim;

  HttpSource(std::unique_ptr<RangeClient> client, std::unique_ptr<ClusterFile> file,
             ObjectIdentity identity, std::size_t clusters);
  void keep_head(std::span<const std::byte> head);
  Result<void> read_piece(std::uint64_t offset, std::span<std::byte> out) const;
  Result<void> load(std::span<Claim> claims, std::chrono::milliseconds max_time) const;
  void read_cached(std::span<Claim> claims) const;
  void note_run(std::span<const Claim> claims) const noexcept;
  std::uint64_t clusters_ahead(std::uint64_t offset, std::size_t bytes) const noexcept;

  const ObjectIdentity identity_;
  const Hash128 key_;
  const std::string name_;
  const std::unique_ptr<RangeClient> client_;
  const std::unique_ptr<ClusterFile> file_;  // null: none
  const std::size_t clusters_;               // in memory
  mutable ClusterMemory memory_;
  mutable std::atomic<std::uint64_t> cached_bytes_{0};
  // The cluster behind the last request, and how many requests before it followed each other.
  mutable std::atomic<std::uint64_t> run_end_{0};
  mutable std::atomic<unsigned> run_length_{0};
};

}  // namespace planetree::storage
