#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// The sources of the repository as text, for tests of rules that hold for all of them.
namespace planetree::layering {

/// All bytes of a file; none if it cannot be read.
std::string read_text(const std::filesystem::path& file);

/// One source or header.
struct SourceText {
  std::string path;  ///< from the root of the repository, with '/' between folders
  std::string text;

  /// The folder of the file, with '/' at its end: "octree/builder/".
  std::string folder() const;
  bool is_header() const { return path.ends_with(".h"); }
};

/// Reads every .h and .cpp file below `root`, sorted by path. Build trees and hidden folders are
/// skipped.
std::vector<SourceText> read_sources(const std::filesystem::path& root);

/// The names in the #include lines of `text`, in order: "storage/system/mapping.h", "vector". Lines
/// in a block comment count too.
std::vector<std::string> includes_of(std::string_view text);

/// Whether `include` names a header of the C++ standard library: no folder, no extension.
bool is_standard_header(std::string_view include);

}  // namespace planetree::layering
