#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "octree/builder/build_identity.h"
#include "octree/builder/work_records.h"
#include "planetree/error.h"
#include "storage/spill/journal.h"
#include "storage/spill/spill_file.h"
#include "storage/spill/work_directory.h"

namespace planetree::octree {

/// What a build completes, kept in a directory until all is done, for another build of the same
/// to go on with: a file with what is spilled, and a journal of what in it counts.
///
/// threads  one, but for keep(), of different patches and regions.
class Checkpoint {
 public:
  /// Takes up what earlier builds of `identity` left at `path`, or begins there: whatever else
  /// they left there is lost.
  ///
  /// calls   the system; must outlive this.
  /// errors  those of storage::WorkDirectory, Journal and SpillFile.
  static Result<std::unique_ptr<Checkpoint>> open(const std::filesystem::path& path,
                                                  const BuildIdentity& identity,
                                                  storage::FileCalls& calls);
  /// Leaves a directory behind only if there is something in it to go on with.
  ~Checkpoint();

  /// What is gone on with, or why nothing is: for a person.
  std::string start() const;

  /// For all that is to be kept.
  storage::SpillFile& spill() { return *spill_; }
  /// Of what was taken up, in spill().
  std::uint64_t taken_up_bytes() const { return taken_up_bytes_; }
  /// Of everything, taken up or not.
  std::uint64_t disk_bytes() const { return spill_->disk_bytes() + journal_.size_bytes(); }
  /// Whether keeping something, or getting it back, ever failed.
  bool failed() const { return spill_->failed() || journal_.failed(); }

  /// What was taken up; the surface only with the mesh.
  const std::optional<OrderedMesh>& mesh() const { return mesh_; }
  const std::optional<SurfaceWork>& surface() const { return surface_; }
  /// Once for a patch.
  std::optional<ChunkWork> take_chunk(std::uint32_t number);
  /// Once.
  std::map<std::uint32_t, BuiltSector> take_sectors() { return std::move(regions_); }

  /// Keeps what a phase came to, durably, with all in spill() by now.
  Result<void> keep(const OrderedMesh& mesh);
  Result<void> keep(const SurfaceWork& surface);
  Result<void> keep(std::uint32_t number, const ChunkWork& chunk);
  Result<void> keep(std::uint32_t number, const BuiltSector& region);

  /// All is done: removes the directory.
  Result<void> remove();

 private:
  enum class Kind : std::uint32_t { kIdentity, kMesh, kSurface, kChunk, kSector };

  Checkpoint(storage::WorkDirectory directory, storage::FileHandle journal)
      : directory_(std::move(directory)), journal_(std::move(journal)) {}
  Result<void> resume(const BuildIdentity& identity, std::uint64_t journal_bytes);
  bool restore(Kind kind, std::span<const std::byte> payload, SpillExtent& extent);
  bool restore_identity(const BuildIdentity& identity, std::span<const std::byte> payload);
  bool restore_surface(std::span<const std::byte> payload, SpillExtent& extent);
  bool restore_chunk(std::span<const std::byte> payload, SpillExtent& extent);
  bool restore_sector(std::span<const std::byte> payload, SpillExtent& extent);
  template <class... Values>
  Result<void> append(Kind kind, const Values&... values);

  storage::WorkDirectory directory_;
  storage::Journal journal_;
  std::optional<storage::SpillFile> spill_;
  bool identified_ = false;
  const char* refusal_ = nullptr;  // why what was there is not gone on with
  std::optional<OrderedMesh> mesh_;
  std::optional<SurfaceWork> surface_;
  std::map<std::uint32_t, ChunkWork> chunks_;
  std::map<std::uint32_t, BuiltSector> regions_;
  std::uint32_t page_bytes_ = 0;
  std::uint64_t taken_up_bytes_ = 0;
  bool removable_ = false;  // there is nothing to go on with
};

}  // namespace planetree::octree
