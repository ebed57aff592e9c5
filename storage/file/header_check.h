#pragma once

#include <cstdint>

#include "planetree/error.h"
#include "storage/file/file_layout.h"

/// Rules of the format for the header. The reader refuses a file that breaks a rule, and the writer
/// checks its own header before it commits the file.
///
/// The arguments must be copies that no other process can change. The functions read nothing else
/// and allocate nothing. The hashes prove only that the bytes are those that were written. The
/// rules are checked in addition, because a hostile file may have correct hashes.
namespace planetree::storage {

/// Checks all fields of a header except its own hash.
///
/// actual_bytes  length of the file.
/// errors        kUnsupported; kTruncated, which states the expected and the actual length;
///               kDamaged.
Result<void> check_header(const FileHeader& header, std::uint64_t actual_bytes) noexcept;

/// Checks the fields of a model record against each other. Fields that describe the tree can only
/// be checked by code that reads the tree.
/// errors  kDamaged.
Result<void> check_model(const ModelRecord& model) noexcept;

}  // namespace planetree::storage
