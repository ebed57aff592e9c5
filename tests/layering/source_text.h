#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// The repository as text, for tests that hold it to the rules of the house.
namespace planetree::layering {

/// One source or header.
struct SourceText {
  std::string path;  ///< from the root of the repository, with '/'
  std::string text;

  /// The folder the file lies in, with '/' at its end: "octree/build/".
  std::string folder() const;
  bool is_header() const { return path.ends_with(".h"); }
};

/// Every .h and .cpp below `root`, sorted by path. Build trees and hidden
/// folders are passed over.
std::vector<SourceText> read_sources(const std::filesystem::path& root);

/// What the #include lines of `text` name, in order: "storage/system/mapping.h",
/// "vector". Lines inside a block comment count too.
std::vector<std::string> includes_of(std::string_view text);

/// A header of the C++ standard library: no folder, no extension.
bool is_standard_header(std::string_view include);

}  // namespace planetree::layering
