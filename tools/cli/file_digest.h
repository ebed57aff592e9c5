#pragma once

#include <filesystem>
#include <string>

#include "planetree/error.h"

namespace planetree::tools {

/// SHA-256 of a file's bytes as 64 lower-case hexadecimal digits, in the form of `sha256sum`.
///
/// errors  as storage::file_error(); kReadFailed where OpenSSL does not provide SHA-256.
Result<std::string> sha256_of_file(const std::filesystem::path& path);

}  // namespace planetree::tools
