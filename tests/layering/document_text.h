#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

/// The Markdown documents of the repository as text, for tests that what they name exists.
namespace planetree::layering {

/// One .md file.
struct Document {
  std::string path;  ///< from the root of the repository, with '/' between folders
  std::string text;  ///< without fenced blocks of code

  /// The targets of its links, in order: "tuning.md#locking". Those to other sites are left out.
  std::vector<std::string> links() const;
  /// The text of each `code span` that lies on one line, in order.
  std::vector<std::string> code_spans() const;
  /// What a link can name after '#': one anchor for each heading.
  std::set<std::string> anchors() const;
};

/// Names that exist in the repository.
struct KnownNames {
  std::set<std::string> paths;  ///< files and folders, from the root
  std::set<std::string> words;  ///< identifiers in sources and scripts

  /// Whether `path` is a file or a folder, or the end of the path of one: "sort/chunks.h".
  bool has_path(std::string_view path) const;
};

/// Reads all documents below `root`, sorted by path. Build trees and hidden folders are skipped.
std::vector<Document> read_documents(const std::filesystem::path& root);
KnownNames read_known_names(const std::filesystem::path& root);

/// Whether a code span is a path in the repository: it has the ending of a source or a document,
/// ends with '/', or begins with a folder of the root.
bool is_path(std::string_view span, const KnownNames& known);

/// The words of a code span that is an identifier, such as `PageFile::unpack` or `help()`. None if
/// it is something else or could be a word of English.
std::vector<std::string> identifier_words(std::string_view span);

}  // namespace planetree::layering
