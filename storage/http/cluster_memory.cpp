#include "storage/http/cluster_memory.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <new>

namespace planetree::storage {

ClusterMemory::ClusterMemory(std::uint64_t size_bytes, std::size_t slots)
    : size_bytes_(size_bytes),
      memory_(new (std::nothrow) std::byte[slots * kClusterBytes]),
      slots_(slots) {
  assert(slots >= kMinSlots);
}

std::span<std::byte> ClusterMemory::bytes_of(std::size_t slot) const noexcept {
  const std::uint64_t left = size_bytes_ - slots_[slot].cluster * kClusterBytes;
  return {memory_.get() + slot * kClusterBytes,
          static_cast<std::size_t>(std::min(left, kClusterBytes))};
}

// The slot that has or loads a cluster.
std::size_t ClusterMemory::find(std::uint64_t cluster) const noexcept {
  for (std::size_t i = 0; i < slots_.size(); ++i)
    if (slots_[i].state != State::kFree && slots_[i].cluster == cluster) return i;
  return kNone;
}

// Takes the slot whose last use is longest ago. Returns false if all are being loaded.
bool ClusterMemory::add_claim(std::uint64_t cluster, std::vector<Claim>& claims) {
  std::size_t oldest = kNone;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i].state == State::kLoading) continue;
    if (oldest == kNone || slots_[i].last_use < slots_[oldest].last_use) oldest = i;
  }
  if (oldest == kNone) return false;
  claims.reserve(claims.size() + 1);  // before the slot changes
  slots_[oldest] = {State::kLoading, cluster, ++uses_};
  claims.push_back({cluster, bytes_of(oldest)});
  return true;
}

// Needs at least one byte.
bool ClusterMemory::are_ready(std::uint64_t offset, std::uint64_t bytes) const noexcept {
  const std::uint64_t last = (offset + bytes - 1) / kClusterBytes;
  for (std::uint64_t cluster = offset / kClusterBytes; cluster <= last; ++cluster) {
    const std::size_t slot = find(cluster);
    if (slot == kNone || slots_[slot].state != State::kReady) return false;
  }
  return true;
}

bool ClusterMemory::has(std::uint64_t offset, std::uint64_t bytes) noexcept {
  const std::lock_guard lock(mutex_);
  return bytes == 0 || are_ready(offset, bytes);
}

bool ClusterMemory::copy(std::uint64_t offset, std::span<std::byte> out) noexcept {
  if (out.empty()) return true;
  if (!are_ready(offset, out.size())) return false;
  const std::uint64_t first = offset / kClusterBytes;
  const std::uint64_t last = (offset + out.size() - 1) / kClusterBytes;
  for (std::uint64_t cluster = first; cluster <= last; ++cluster) {
    const std::size_t slot = find(cluster);
    slots_[slot].last_use = ++uses_;
    const auto at = static_cast<std::size_t>(offset - cluster * kClusterBytes);
    const std::size_t count = std::min(bytes_of(slot).size() - at, out.size());
    std::memcpy(out.data(), bytes_of(slot).data() + at, count);
    out = out.subspan(count);
    offset += count;
  }
  return true;
}

bool ClusterMemory::try_copy(std::uint64_t offset, std::span<std::byte> out) noexcept {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  return lock.owns_lock() && copy(offset, out);
}

void ClusterMemory::copy_or_claim(std::uint64_t offset, std::span<std::byte> out,
                                  std::uint64_t ahead, std::vector<Claim>& claims) {
  std::unique_lock lock(mutex_);
  claims.clear();
  while (!copy(offset, out)) {
    const std::uint64_t first = offset / kClusterBytes;
    const std::uint64_t last = (offset + out.size() - 1) / kClusterBytes;
    for (std::uint64_t cluster = first; cluster <= last; ++cluster)
      if (find(cluster) == kNone) add_claim(cluster, claims);
    if (!claims.empty()) {
      const std::uint64_t end = std::min(last + 1 + ahead, cluster_count());
      for (std::uint64_t cluster = last + 1; cluster < end && find(cluster) == kNone; ++cluster)
        if (!add_claim(cluster, claims)) break;
      return;
    }
    loaded_.wait(lock);
  }
}

std::vector<ClusterMemory::Claim> ClusterMemory::claim(std::span<const std::uint64_t> clusters) {
  std::vector<Claim> claims;
  const std::lock_guard lock(mutex_);
  for (const std::uint64_t cluster : clusters) {
    if (claims.size() == slots_.size() / 2) break;
    const std::size_t slot = find(cluster);
    if (slot != kNone) {
      slots_[slot].last_use = ++uses_;
    } else if (!add_claim(cluster, claims)) {
      break;
    }
  }
  return claims;
}

void ClusterMemory::finish(std::span<const Claim> claims) noexcept {
  {
    const std::lock_guard lock(mutex_);
    for (const Claim& claim : claims) {
      Slot& slot = slots_[find(claim.cluster)];
      slot.state = claim.is_loaded ? State::kReady : State::kFree;
      if (!claim.is_loaded) slot.last_use = 0;
    }
  }
  loaded_.notify_all();
}

void ClusterMemory::forget(std::uint64_t first, std::uint64_t last) noexcept {
  const std::lock_guard lock(mutex_);
  for (Slot& slot : slots_)
    if (slot.state == State::kReady && slot.cluster >= first && slot.cluster <= last) slot = Slot{};
}

}  // namespace planetree::storage
