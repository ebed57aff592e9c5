#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "planetree/error.h"

namespace planetree::storage {

/// Whether a path or a URL names a set: whether it ends in `.ptreeset`, in any case. What follows
/// `?` or `#` in a URL does not count.
[[nodiscard]] bool is_set_name(std::string_view path);

/// Returns the path or the URL of a member.
///
/// set      path or URL of the set file
/// address  of the member, as the set file has it
/// errors   kUnsupported: a set file on a server names a file of this machine
Result<std::filesystem::path> member_path(const std::filesystem::path& set,
                                          const std::string& address);

}  // namespace planetree::storage
