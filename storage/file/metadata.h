#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "planetree/metadata.h"
#include "storage/file/extension.h"
#include "storage/file/page_file.h"

/// The extension `metadata`: lines of `key: value`. format-spec/v1/spec.md, "Metadata".
namespace planetree::storage {

/// Checks keys and values.
///
/// errors  kBadArgument: a key or a value breaks a rule, or all are too long.
Result<void> check_metadata(const Metadata& metadata);

/// The extensions of a file with this metadata, which check_metadata() accepts: none if it is
/// empty.
std::vector<Extension> extensions_of(const Metadata& metadata);

/// Reads the metadata of a file. Empty if it has none.
///
/// errors  those of PageFile::read_extension(); kDamaged: the bytes break a rule.
Result<Metadata> read_metadata(const PageFile& file);

/// Reads the bytes of the extension.
///
/// errors  kDamaged: they break a rule.
Result<Metadata> parse_metadata(std::span<const std::byte> bytes);

}  // namespace planetree::storage
