#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace planetree::storage {

/// The unit in which an object is read: kClusterBytes from a multiple of them on. The last one may
/// be shorter.
inline constexpr std::uint64_t kClusterBytes = std::uint64_t{256} << 10;

/// The clusters of an object that were used last, in memory. A cluster that is absent is claimed by
/// one thread, which loads it; other threads that need it wait for that thread.
///
/// threads  any number at once
class ClusterMemory {
 public:
  /// Fewer do not suffice for one copy, which other threads let wait.
  static constexpr std::size_t kMinSlots = 8;
  /// Maximum number of bytes of one copy.
  static constexpr std::uint64_t kMaxCopyBytes = 4 * kClusterBytes;

  /// A cluster that a thread is to load, and where.
  struct Claim {
    std::uint64_t cluster = 0;
    std::span<std::byte> bytes;
    bool is_loaded = false;
  };

  /// Takes memory for `slots` clusters. ok() says whether the system gave it.
  ///
  /// slots   at least kMinSlots. A batch of points reads at several places of the file in turns:
  ///         one for each level of the trees, and for each thread. With 24 slots they displaced
  ///         each other.
  /// throws  std::bad_alloc
  ClusterMemory(std::uint64_t size_bytes, std::size_t slots);
  bool ok() const noexcept { return memory_ != nullptr; }

  /// Copies bytes if all their clusters are here, and no other thread is in the way.
  bool try_copy(std::uint64_t offset, std::span<std::byte> out) noexcept;
  /// Whether all clusters of a range are here.
  bool has(std::uint64_t offset, std::uint64_t bytes) noexcept;
  /// Copies bytes, or claims those of their clusters that are absent. Waits for other threads that
  /// load some of them.
  ///
  /// out     at most kMaxCopyBytes, within the object
  /// ahead   claim up to so many absent clusters behind the last one as well
  /// claims  receives the claims; empty: the bytes were copied
  /// throws  std::bad_alloc
  void copy_or_claim(std::uint64_t offset, std::span<std::byte> out, std::uint64_t ahead,
                     std::vector<Claim>& claims);
  /// Claims clusters that are absent, as far as half of the slots suffice. Does not wait.
  ///
  /// clusters  below the number of clusters
  /// throws    std::bad_alloc
  std::vector<Claim> claim(std::span<const std::uint64_t> clusters);
  /// Ends claims: shows the loaded ones to all threads.
  void finish(std::span<const Claim> claims) noexcept;
  /// Removes clusters, unless a thread is loading them.
  void forget(std::uint64_t first, std::uint64_t last) noexcept;

  std::uint64_t cluster_count() const noexcept {
    return (size_bytes_ + kClusterBytes - 1) / kClusterBytes;
  }

 private:
  enum class State : std::uint8_t { kFree, kLoading, kReady };
  struct Slot {
    State state = State::kFree;
    std::uint64_t cluster = 0;
    std::uint64_t last_use = 0;
  };
  static constexpr std::size_t kNone = ~std::size_t{0};

  std::span<std::byte> bytes_of(std::size_t slot) const noexcept;
  std::size_t find(std::uint64_t cluster) const noexcept;
  bool add_claim(std::uint64_t cluster, std::vector<Claim>& claims);
  bool are_ready(std::uint64_t offset, std::uint64_t bytes) const noexcept;
  bool copy(std::uint64_t offset, std::span<std::byte> out) noexcept;

  const std::uint64_t size_bytes_;
  std::unique_ptr<std::byte[]> memory_;
  std::mutex mutex_;
  std::condition_variable loaded_;
  std::vector<Slot> slots_;
  std::uint64_t uses_ = 0;
};

}  // namespace planetree::storage
