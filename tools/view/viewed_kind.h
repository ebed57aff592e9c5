#pragma once

#include <filesystem>

#include "planetree/error.h"

namespace planetree::tools {

/// What a file that is to be viewed holds.
enum class ViewedKind {
  kModel,  ///< it is a .ptree file
  kScene,  ///< it is a scene file
};

/// Tells the kind of a file by its first bytes, or else by its extension.
///
/// errors  kNotFound, kPermission, kReadFailed; kBadInput: it is of neither kind
Result<ViewedKind> viewed_kind(const std::filesystem::path& file);

}  // namespace planetree::tools
