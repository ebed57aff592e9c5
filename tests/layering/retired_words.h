#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Words that the project no longer uses, as docs/glossary.md lists them.
namespace planetree::layering {

/// A word in the first column of the table "Retired words".
struct RetiredWord {
  std::string text;           ///< without quotes, backticks and '*'
  bool is_phrase = false;     ///< "quoted": found in any case, with line breaks for blanks
  bool is_beginning = false;  ///< `word*`: of identifiers
};

/// The words of the table in a glossary.
std::vector<RetiredWord> retired_words(std::string_view glossary);

/// One line "path:line: word" for each place in `text` that uses a retired word.
std::vector<std::string> uses_of(const std::vector<RetiredWord>& words, const std::string& path,
                                 std::string_view text);

/// Paths of the texts below `root` that must not use retired words: sources, documents, scripts,
/// CMake. Not the glossary, changelogs, dated experiments, samples and fuzz seeds.
std::vector<std::string> texts_to_search(const std::filesystem::path& root);

}  // namespace planetree::layering
