#pragma once

#include <filesystem>
#include <string>

#include "planetree/error.h"
#include "storage/system/byte_source.h"

namespace planetree::tools {

/// SHA-256 of a file's bytes as 64 lower-case hexadecimal digits, in the form of `sha256sum`.
///
/// errors  as storage::file_error(); kReadFailed where OpenSSL does not provide SHA-256.
Result<std::string> sha256_of_file(const std::filesystem::path& path);
/// The same of the bytes of a source.
///
/// errors  those of reading it; kReadFailed where OpenSSL does not provide SHA-256.
Result<std::string> sha256_of(const storage::ByteSource& source);

}  // namespace planetree::tools
