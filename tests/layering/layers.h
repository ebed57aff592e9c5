#pragma once

#include "tests/layering/source_text.h"

#include <string>
#include <string_view>
#include <vector>

/// Who may include whom.
namespace planetree::layering {

/// How include names may begin. "octree/" means what lies in that folder but
/// not in folders below it; "hwy" means whatever begins so; "png.h" is itself.
using Beginnings = std::vector<std::string_view>;

/// A folder and what its files may include beside the standard library.
struct Layer {
  std::string_view folder;  ///< from the root of the repository, with '/' at its end
  Beginnings allowed;
};

/// A library that few files, or folders, keep to themselves.
struct KeptHeader {
  std::string_view beginning;  ///< of the include name
  Beginnings includers;        ///< paths from the root of the repository
};

const std::vector<Layer>& layers();
const std::vector<KeptHeader>& kept_headers();

/// One line per include of `source` that its layer, or the keeper of a header,
/// forbids; empty when all is well.
std::vector<std::string> forbidden_includes(const SourceText& source);

}  // namespace planetree::layering
