#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <utility>

#include "planetree/error.h"
#include "storage/spill/spill_file.h"
#include "storage/system/file_calls.h"

namespace planetree::octree {

class MeshFile;

/// Resources for reading a mesh: memory, and a directory for temporary files.
///
/// threads  one at a time.
class MeshScratch {
 public:
  static constexpr std::uint64_t kMemoryBytes = std::uint64_t{256} << 20;

  /// memory_bytes  approximate maximum of memory for the mesh.
  /// directory     for what does not fit in memory.
  /// calls         the system; must outlive this.
  MeshScratch(std::uint64_t memory_bytes, std::filesystem::path directory,
              storage::FileCalls& calls = storage::FileCalls::real())
      : memory_bytes_(memory_bytes), directory_(std::move(directory)), calls_(calls) {}
  /// Uses the system's directory for temporary files.
  explicit MeshScratch(std::uint64_t memory_bytes = kMemoryBytes);

  [[nodiscard]] std::uint64_t memory_bytes() const { return memory_bytes_; }
  [[nodiscard]] storage::FileCalls& calls() const { return calls_; }

  /// The part of the memory for joining corners with vertices. The rest is for a window of the file
  /// and, of a text, for vertices.
  [[nodiscard]] std::uint64_t join_bytes(bool is_text) const {
    return memory_bytes_ - window_bytes() - (is_text ? text_bytes(memory_bytes_) : 0);
  }
  static constexpr std::uint64_t text_bytes(std::uint64_t memory_bytes) { return memory_bytes / 2; }
  [[nodiscard]] std::uint64_t window_bytes() const {
    return std::min(memory_bytes_ / 4, kWindowBytes);
  }

  /// Sets what is called once corners have to be sorted on disk, before any of them is written. Its
  /// error ends the reading.
  void before_sorting(std::function<Result<void>()> hook) { before_sorting_ = std::move(hook); }
  Result<void> begin_sorting() const {
    return before_sorting_ ? before_sorting_() : Result<void>();
  }

  /// Sets what is called now and then while a compressed mesh is unpacked, with the bytes that are
  /// to be written next. Its error ends the reading.
  void before_unpacking(std::function<Result<void>(std::uint64_t bytes)> hook) {
    before_unpacking_ = std::move(hook);
  }
  Result<void> make_room(std::uint64_t bytes) const {
    return before_unpacking_ ? before_unpacking_(bytes) : Result<void>();
  }
  /// Sets what is called once a compressed mesh is unpacked, with its content. Its error ends the
  /// reading.
  void after_unpacking(std::function<Result<void>(const MeshFile&)> hook) {
    after_unpacking_ = std::move(hook);
  }
  Result<void> note_unpacked(const MeshFile& content) const {
    return after_unpacking_ ? after_unpacking_(content) : Result<void>();
  }

  /// Notes which file is read from now on, or that its reading is complete. After an error, file()
  /// is the file that the error concerns.
  void begin_file(const std::filesystem::path& path) { file_ = path; }
  void end_file() { file_.clear(); }
  /// The file that is being read; empty if none is.
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

  /// Bytes that closed temporary files had on disk, together.
  [[nodiscard]] std::uint64_t disk_bytes() const { return disk_bytes_; }
  /// Whether one of the closed temporary files failed.
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  friend class ScratchFile;
  static constexpr std::uint64_t kWindowBytes = std::uint64_t{1} << 20;

  const std::uint64_t memory_bytes_;
  const std::filesystem::path directory_;
  storage::FileCalls& calls_;
  std::function<Result<void>()> before_sorting_;
  std::function<Result<void>(std::uint64_t bytes)> before_unpacking_;
  std::function<Result<void>(const MeshFile&)> after_unpacking_;
  std::filesystem::path file_;
  std::uint64_t disk_bytes_ = 0;
  bool failed_ = false;
};

/// A temporary file. Its MeshScratch must outlive it.
class ScratchFile {
 public:
  /// held_bytes  maximum of its bytes in memory.
  explicit ScratchFile(MeshScratch& scratch, std::uint64_t held_bytes = 0)
      : scratch_(scratch), spill_(scratch.directory_, held_bytes, scratch.calls_) {}
  ~ScratchFile() {
    scratch_.disk_bytes_ += spill_.disk_bytes();
    scratch_.failed_ |= spill_.failed();
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  [[nodiscard]] storage::SpillFile& spill() { return spill_; }

 private:
  MeshScratch& scratch_;
  storage::SpillFile spill_;
};

}  // namespace planetree::octree
