#pragma once

#include <filesystem>
#include <string>

#include "planetree/error.h"

namespace planetree::tools {

/// SHA-256 of a file's bytes as 64 lower-case hexadecimal digits, as
/// `sha256sum` prints it.
///
/// errors  as storage::file_error(); kReadFailed where the library of
///         cryptography does not serve.
Result<std::string> sha256_of_file(const std::filesystem::path& path);

}  // namespace planetree::tools
