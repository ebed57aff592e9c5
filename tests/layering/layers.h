#pragma once

#include "tests/layering/source_text.h"

#include <string>
#include <string_view>
#include <vector>

/// Rules about which folder may include which.
namespace planetree::layering {

/// Beginnings of include names. "octree/" stands for files in that folder but not in folders below
/// it, "hwy" for any name that begins with it, "png.h" for that name.
using Beginnings = std::vector<std::string_view>;

/// A folder, and what its files may include besides the standard library.
struct Layer {
  std::string_view folder;  ///< path from the root of the repository, with '/' at its end
  Beginnings allowed;
};

/// A library that only a few files or folders may include.
struct KeptHeader {
  std::string_view beginning;  ///< beginning of the include name
  Beginnings includers;        ///< paths from the root of the repository
};

const std::vector<Layer>& layers();
const std::vector<KeptHeader>& kept_headers();

/// One line for each include of `source` that its layer or a kept header forbids. Empty if there is
/// none.
std::vector<std::string> forbidden_includes(const SourceText& source);

}  // namespace planetree::layering
