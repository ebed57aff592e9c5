#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "storage/file/checksum.h"
#include "storage/system/file_calls.h"
#include "storage/system/file_handle.h"
#include "storage/system/new_file.h"

namespace planetree::storage {

/// A file that one process leaves for others, perhaps on other machines: data of any size and a
/// record that says what the data is. The id is a hash of all of it, so that a later step can name
/// its inputs. In the machine's byte order.
///
///   data    any bytes, in blocks of kBlockBytes
///   hashes  of the blocks, 8 bytes each
///   record  any bytes
///   footer  lengths, kind and id
///
/// threads  any number may read.
class ResultFile {
 public:
  /// Bytes of the data that are hashed, and so read, together.
  static constexpr std::size_t kBlockBytes = 32768;

  /// Opens a file and reads its record.
  ///
  /// kind    what the file must be, by the same number as it was written with.
  /// calls   the system; must outlive the file.
  /// errors  those of file_error(), among them kNotFound; kBadInput: the file is none of this kind;
  ///         kTruncated; kDamaged: hashes differ.
  static Result<ResultFile> open(const std::filesystem::path& path, std::uint64_t kind,
                                 FileCalls& calls = FileCalls::real());

  /// Hash of the data, the record and the kind.
  const Hash128& id() const { return id_; }
  std::span<const std::byte> record() const { return record_; }
  std::uint64_t data_bytes() const { return data_bytes_; }

  /// Reads a part of the data, and checks the blocks that it lies in.
  /// errors  those of file_error(); kTruncated; kDamaged: a block differs from what was written.
  Result<void> read(std::uint64_t offset, std::span<std::byte> out) const;

 private:
  friend class NewResultFile;
  struct Footer;

  Result<void> read_block(std::uint64_t block, std::span<std::byte> out) const;
  Result<void> check_block(std::uint64_t block, std::span<const std::byte> bytes) const;
  std::size_t bytes_of_block(std::uint64_t block) const;
  static Hash128 id_of(std::uint64_t kind, std::uint64_t data_bytes,
                       std::span<const std::uint64_t> hashes, std::span<const std::byte> record);

  Error damaged(std::uint64_t offset) const;

  std::string name_;
  FileHandle file_;
  std::uint64_t data_bytes_ = 0;
  std::vector<std::uint64_t> hashes_;
  std::vector<std::byte> record_;
  Hash128 id_{};
};

/// A result file that is being written. It appears under its name complete or not at all.
///
/// threads  one at a time; but any number may write to file() before finish().
class NewResultFile {
 public:
  /// replace  whether an earlier file may be replaced.
  /// errors   those of NewFile::create().
  static Result<NewResultFile> create(const std::filesystem::path& path, bool replace,
                                      FileCalls& calls = FileCalls::real());

  /// Receives the data, from its start on.
  const FileHandle& file() const { return file_.file(); }
  /// Reads the data back to hash it, adds the record and commits the file. Call it once.
  ///
  /// data_bytes  length of the data.
  /// return      the id.
  /// errors      those of FileHandle and NewFile::commit().
  Result<Hash128> finish(std::uint64_t kind, std::uint64_t data_bytes,
                         std::span<const std::byte> record);

 private:
  explicit NewResultFile(NewFile file) : file_(std::move(file)) {}
  Result<std::vector<std::uint64_t>> hash_data(std::uint64_t data_bytes) const;

  NewFile file_;
};

}  // namespace planetree::storage
