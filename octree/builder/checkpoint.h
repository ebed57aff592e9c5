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

/// The completed work of a build, kept in a directory until the build is done, so that another
/// build of the same input and options can resume it. The directory holds a file with spilled data,
/// and a journal that says what in the file counts.
///
/// threads  one; but any number may call keep() for different chunks and sectors.
class Checkpoint {
 public:
  /// Resumes the work that earlier builds of `identity` left at `path`, or begins there. Other work
  /// that earlier builds left there is lost.
  ///
  /// calls   the system; must outlive this.
  /// errors  those of storage::WorkDirectory, Journal and SpillFile.
  static Result<std::unique_ptr<Checkpoint>> open(const std::filesystem::path& path,
                                                  const BuildIdentity& identity,
                                                  storage::FileCalls& calls);
  /// Leaves the directory behind only if it holds work that can be resumed.
  ~Checkpoint();

  /// A message for a person: what work is resumed, or why none is.
  std::string start() const;

  /// The file for all spilled data that is to be kept.
  storage::SpillFile& spill() { return *spill_; }
  /// Bytes of resumed work in spill().
  std::uint64_t resumed_bytes() const { return resumed_bytes_; }
  /// Bytes on disk, of resumed and of new work.
  std::uint64_t disk_bytes() const { return spill_->disk_bytes() + journal_.size_bytes(); }
  /// Whether storing or reading work ever failed.
  bool failed() const { return spill_->failed() || journal_.failed(); }

  /// The resumed work. There is a surface only if there is a mesh.
  const std::optional<OrderedMesh>& mesh() const { return mesh_; }
  const std::optional<SurfaceWork>& surface() const { return surface_; }
  /// Takes the resumed work of a chunk; once for each chunk.
  std::optional<ChunkWork> take_chunk(std::uint32_t number);
  /// Takes the resumed work of all sectors; once.
  std::map<std::uint32_t, BuiltSector> take_sectors() { return std::move(sectors_); }

  /// Stores the result of a phase durably, with everything that is in spill() so far.
  Result<void> keep(const OrderedMesh& mesh);
  Result<void> keep(const SurfaceWork& surface);
  Result<void> keep(std::uint32_t number, const ChunkWork& chunk);
  Result<void> keep(std::uint32_t number, const BuiltSector& sector);

  /// Removes the directory. Call it when the build is done.
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
  std::string refusal_;  // why earlier work is not resumed
  std::optional<OrderedMesh> mesh_;
  std::optional<SurfaceWork> surface_;
  std::map<std::uint32_t, ChunkWork> chunks_;
  std::map<std::uint32_t, BuiltSector> sectors_;
  std::uint64_t resumed_bytes_ = 0;
  bool removable_ = false;  // there is no work to resume
};

}  // namespace planetree::octree
