#include "storage/http/cluster_file.h"

#include <fcntl.h>

#include <cerrno>
#include <cinttypes>
#include <cstring>
#include <new>
#include <system_error>
#include <utility>

#include "storage/system/file_error.h"

namespace planetree::storage {
namespace {

constexpr std::uint64_t kHeadMagic = 0x316c637274707089;  // also the version of the layout
constexpr std::uint64_t kHeadSpace = 4096;
constexpr std::uint64_t kNoSlot = ~std::uint64_t{0};
constexpr const char* kFileName = "planetree-clusters";

}  // namespace

struct ClusterFile::Head {
  std::uint64_t magic;
  Hash128 object;
  std::uint64_t cluster;
  std::uint64_t bytes;
  std::uint64_t hash;  // of the bytes

  bool is_of(const Hash128& its_object, std::uint64_t its_cluster) const noexcept {
    return magic == kHeadMagic && object == its_object && cluster == its_cluster;
  }
};

ClusterFile::ClusterFile(FileHandle file, std::uint64_t slots) noexcept
    : file_(std::move(file)), slots_(slots) {}

Result<std::unique_ptr<ClusterFile>> ClusterFile::open(const std::filesystem::path& directory,
                                                       std::uint64_t max_bytes, FileCalls& calls) {
  if (max_bytes < kMinBytes)
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "an HTTP cache of %" PRIu64 " bytes is not possible; give at least %" PRIu64,
                      max_bytes, kMinBytes);
  std::error_code failed;
  if (std::filesystem::create_directories(directory, failed); failed)
    return file_error(failed.value(), FileAction::kWrite, "create the directory of the HTTP cache");
  // Another user must neither read the models nor put bytes in.
  constexpr mode_t kOwnerOnly = 0600;
  FileHandle file = FileHandle::open(calls, AT_FDCWD, (directory / kFileName).c_str(),
                                     O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK, kOwnerOnly);
  if (!file.is_open()) return file_error(errno, FileAction::kWrite, "open the HTTP cache");
  const std::uint64_t slots = max_bytes / kSlotBytes / kWays * kWays;
  const auto bytes = file.size_bytes();
  if (!bytes) return bytes.error();
  if (*bytes > slots * kSlotBytes)
    if (const auto cut = file.truncate(slots * kSlotBytes); !cut) return cut.error();
  std::unique_ptr<ClusterFile> opened(new (std::nothrow) ClusterFile(std::move(file), slots));
  if (!opened) return file_error(ENOMEM, FileAction::kWrite, "open the HTTP cache");
  return opened;
}

std::uint64_t ClusterFile::first_slot(const Hash128& object, std::uint64_t cluster) const noexcept {
  const std::uint64_t words[] = {object.low, object.high, cluster};
  return hash64(std::as_bytes(std::span(words))) % (slots_ / kWays) * kWays;
}

bool ClusterFile::read_head(std::uint64_t slot, Head& head) const noexcept {
  const auto bytes = std::as_writable_bytes(std::span(&head, 1));
  return static_cast<bool>(file_.read_at(slot * kSlotBytes, bytes));
}

std::uint64_t ClusterFile::find(const Hash128& object, std::uint64_t cluster,
                                Head& head) const noexcept {
  const std::uint64_t first = first_slot(object, cluster);
  for (std::uint64_t slot = first; slot < first + kWays; ++slot)
    if (read_head(slot, head) && head.is_of(object, cluster)) return slot;
  return kNoSlot;
}

bool ClusterFile::read(const Hash128& object, std::uint64_t cluster,
                       std::span<std::byte> out) const noexcept {
  Head head;
  const std::uint64_t slot = find(object, cluster, head);
  if (slot == kNoSlot || head.bytes != out.size()) return false;
  return file_.read_at(slot * kSlotBytes + kHeadSpace, out) && hash64(out) == head.hash;
}

void ClusterFile::write(const Hash128& object, std::uint64_t cluster,
                        std::span<const std::byte> bytes) const noexcept {
  Head head{};
  std::uint64_t slot = find(object, cluster, head);
  if (slot == kNoSlot) {
    const std::uint64_t first = first_slot(object, cluster);
    // An empty slot, or one of the others at random.
    slot = first + hash64(bytes) % kWays;
    for (std::uint64_t way = first; way < first + kWays; ++way) {
      if (read_head(way, head) && head.magic == kHeadMagic) continue;
      slot = way;
      break;
    }
  }
  head = {};
  // Until the new head is there, the slot has none.
  const std::uint64_t at = slot * kSlotBytes;
  if (!file_.write_at(at, std::as_bytes(std::span(&head, 1)))) return;
  if (!file_.write_at(at + kHeadSpace, bytes)) return;
  head = {kHeadMagic, object, cluster, bytes.size(), hash64(bytes)};
  static_cast<void>(file_.write_at(at, std::as_bytes(std::span(&head, 1))));
}

void ClusterFile::forget(const Hash128& object, std::uint64_t cluster) const noexcept {
  Head head;
  const std::uint64_t slot = find(object, cluster, head);
  if (slot == kNoSlot) return;
  head = {};
  static_cast<void>(file_.write_at(slot * kSlotBytes, std::as_bytes(std::span(&head, 1))));
}

}  // namespace planetree::storage
