#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "planetree/error.h"
#include "storage/file/file_layout.h"

/// Extensions: bytes with a name, which a file has besides the model.
namespace planetree::storage {

/// An extension that is to be written.
struct Extension {
  std::string name;  ///< as in ExtensionRecord
  std::vector<std::byte> bytes;
  bool required = false;  ///< a reader that does not know the name refuses the file
};

/// Name of the extension that says what the model is; see "Metadata" in format-spec/v1/spec.md.
inline constexpr std::string_view kMetadataName = "metadata";

/// The name of a record, without the zeros behind it.
[[nodiscard]] std::string_view name_of(const ExtensionRecord& record) noexcept;

/// Whether an extension can have this name.
[[nodiscard]] bool is_extension_name(std::string_view name) noexcept;

/// Makes the record of an extension whose bytes are at `offset`.
[[nodiscard]] ExtensionRecord record_of(const Extension& extension, std::uint64_t offset) noexcept;

/// Checks the records of a file against its header, which must have passed check_header(): their
/// hash, names and flags, and that the extensions fill the file from the last page to the header's
/// copy.
///
/// errors  kUnsupported: a required extension that this program does not know; kDamaged
Result<void> check_extensions(const FileHeader& header,
                              std::span<const ExtensionRecord> records) noexcept;

}  // namespace planetree::storage
