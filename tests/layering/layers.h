#pragma once

#include "tests/layering/source_text.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

/// Rules about which folder may include which.
namespace planetree::layering {

using Names = std::vector<std::string_view>;

/// A folder, and what its files may include besides the standard library, each other and
/// include/planetree.
struct Layer {
  std::string_view folder;  ///< from the root of the repository: "octree/page"
  Names includes;           ///< folders whose headers its files include
  Names sees;               ///< folders that those headers include in turn, and no others
  Names libraries;          ///< beginnings of the names of other headers
};

/// A library that only a few files or folders may include.
struct RestrictedHeader {
  std::string_view beginning;  ///< beginning of the include name
  Names includers;             ///< beginnings of paths from the root of the repository
};

/// One row for each folder of sources, the lowest first.
const std::vector<Layer>& layers();
const std::vector<RestrictedHeader>& restricted_headers();

/// The row of a folder, or null.
const Layer* layer_of(std::string_view folder);

/// One line for each include of `source` that its row or a kept header forbids. Empty if there is
/// none. Sources of tests and benchmarks have no row; others must have one.
std::vector<std::string> forbidden_includes(const SourceText& source);

/// One line for each folder that the includes of `source` reach, one after the other, and that its
/// row does not name.
///
/// sources  all sources by path.
std::vector<std::string> forbidden_reach(const SourceText& source,
                                         const std::map<std::string, SourceText>& sources);

/// One line for each row that includes a row that does not stand before it: an arrow that runs back
/// up.
std::vector<std::string> arrows_back_up(const std::vector<Layer>& rows);

}  // namespace planetree::layering
