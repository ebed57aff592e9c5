#include "octree/builder/checkpoint.h"

#include <utility>

namespace planetree::octree {
namespace {

template <class... Values>
bool read_record(std::span<const std::byte> payload, Values&... values) {
  RecordReader record(payload);
  record(values...);
  return record.fits();
}

}  // namespace

Result<std::unique_ptr<Checkpoint>> Checkpoint::open(const std::filesystem::path& path,
                                                     const BuildIdentity& identity,
                                                     storage::FileCalls& calls) {
  auto directory = storage::WorkDirectory::open(path, calls);
  if (!directory) return directory.error();
  auto journal = directory->open_file("journal");
  if (!journal) return journal.error();
  const auto journal_bytes = journal->size_bytes();
  if (!journal_bytes) return journal_bytes.error();
  std::unique_ptr<Checkpoint> work(new Checkpoint(*std::move(directory), *std::move(journal)));
  work->removable_ = *journal_bytes == 0;
  if (const auto taken = work->resume(identity, *journal_bytes); !taken) return taken.error();
  return work;
}

// The journal is truncated before the file that it refers to.
Result<void> Checkpoint::resume(const BuildIdentity& identity, std::uint64_t journal_bytes) {
  auto file = directory_.open_file("spill");
  if (!file) return file.error();
  const auto file_bytes = file->size_bytes();
  if (!file_bytes) return file_bytes.error();
  SpillExtent extent(*file_bytes);
  if (journal_bytes > 0) refusal_ = "its journal is damaged";
  const auto replayed =
      journal_.replay([&](std::uint32_t kind, std::span<const std::byte> payload) {
        if (identified_) {
          SpillExtent with_it = extent;
          const bool taken = restore(static_cast<Kind>(kind), payload, with_it);
          if (taken) extent = with_it;
          return taken;
        }
        return kind == static_cast<std::uint32_t>(Kind::kIdentity) &&
               restore_identity(identity, payload);
      });
  if (!replayed) return replayed;
  removable_ = !mesh_;
  resumed_bytes_ = extent.bytes();
  if (*file_bytes > extent.end())
    if (const auto cut = file->truncate(extent.end()); !cut) return cut;
  spill_.emplace(*std::move(file), extent.end());
  if (identified_) return {};
  if (const auto begun = append(Kind::kIdentity, identity); !begun) return begun;
  return directory_.sync_names();
}

bool Checkpoint::restore_identity(const BuildIdentity& identity,
                                  std::span<const std::byte> payload) {
  BuildIdentity earlier;
  if (!read_record(payload, earlier)) earlier = {};
  refusal_ = identity.change_since(earlier);
  identified_ = refusal_.empty();
  return identified_;
}

bool Checkpoint::restore(Kind kind, std::span<const std::byte> payload, SpillExtent& extent) {
  refusal_ = "its files do not fit each other";
  if (kind == Kind::kMesh && !mesh_) {
    OrderedMesh mesh;
    if (!read_record(payload, mesh) || !extent.take(mesh)) return false;
    mesh_ = std::move(mesh);
    return true;
  }
  if (kind == Kind::kSurface && mesh_ && !surface_) return restore_surface(payload, extent);
  if (!surface_) return false;
  return kind == Kind::kChunk    ? restore_chunk(payload, extent)
         : kind == Kind::kSector ? restore_sector(payload, extent)
                                 : false;
}

bool Checkpoint::restore_surface(std::span<const std::byte> payload, SpillExtent& extent) {
  SurfaceWork surface;
  if (!read_record(payload, surface) || !extent.take(surface, mesh_->frame.float64)) return false;
  surface_ = std::move(surface);
  return true;
}

bool Checkpoint::restore_chunk(std::span<const std::byte> payload, SpillExtent& extent) {
  std::uint32_t number = 0;
  ChunkWork chunk;
  if (!read_record(payload, number, chunk) || !extent.take(chunk, mesh_->frame.float64))
    return false;
  chunks_.insert_or_assign(number, std::move(chunk));
  return true;
}

bool Checkpoint::restore_sector(std::span<const std::byte> payload, SpillExtent& extent) {
  std::uint32_t number = 0;
  BuiltSector sector;
  if (!read_record(payload, number, sector) || !extent.take(number, sector)) return false;
  sectors_.insert_or_assign(number, std::move(sector));
  return true;
}

Checkpoint::~Checkpoint() {
  // The next build could only begin from the start. An error of remove() is ignored: the one that
  // led here says more.
  if (removable_) (void)remove();
}

std::string Checkpoint::start() const {
  if (!sectors_.empty())
    return "resuming after " + std::to_string(sectors_.size()) + " parts of the mask";
  if (mesh_ && !surface_) return "resuming after ordering";
  if (mesh_ && chunks_.empty()) return "resuming after matching edges";
  if (mesh_) return "resuming after " + std::to_string(chunks_.size()) + " parts of the tree";
  if (refusal_.empty()) return "no checkpoint; building from the start";
  return "the checkpoint cannot be resumed: " + refusal_ + "; building from the start";
}

std::optional<ChunkWork> Checkpoint::take_chunk(std::uint32_t number) {
  const auto found = chunks_.find(number);
  if (found == chunks_.end()) return {};
  return std::move(found->second);
}

template <class... Values>
Result<void> Checkpoint::append(Kind kind, const Values&... values) {
  RecordWriter record;
  record(values...);
  if (const auto synced = spill_->sync(); !synced) return synced;
  return journal_.append(static_cast<std::uint32_t>(kind), record.bytes());
}

Result<void> Checkpoint::keep(const OrderedMesh& mesh) {
  auto kept = append(Kind::kMesh, mesh);
  if (kept) removable_ = false;
  return kept;
}

Result<void> Checkpoint::keep(const SurfaceWork& surface) {
  return append(Kind::kSurface, surface);
}

Result<void> Checkpoint::keep(std::uint32_t number, const ChunkWork& chunk) {
  return append(Kind::kChunk, number, chunk);
}

Result<void> Checkpoint::keep(std::uint32_t number, const BuiltSector& sector) {
  return append(Kind::kSector, number, sector);
}

Result<void> Checkpoint::remove() {
  removable_ = false;
  return directory_.remove();
}

}  // namespace planetree::octree
