#include "tests/layering/retired_words.h"

#include <algorithm>
#include <cctype>
#include <set>

namespace planetree::layering {
namespace {

namespace fs = std::filesystem;

bool is_word_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

/// The text in lower case, with each run of blanks, line breaks and comment marks as one blank, so
/// that a phrase is found across lines. Keeps the line of each character.
struct Flattened {
  std::string text;
  std::vector<std::size_t> line;
};

Flattened flatten(std::string_view text) {
  Flattened flat;
  std::size_t line = 1;
  for (const char c : text) {
    const bool blank = std::isspace(static_cast<unsigned char>(c)) != 0 || c == '/' || c == '#';
    if (!blank || flat.text.empty() || flat.text.back() != ' ') {
      flat.text += blank ? ' ' : lower(c);
      flat.line.push_back(line);
    }
    if (c == '\n') ++line;
  }
  return flat;
}

/// Offsets where `word` stands in `text` and is not a part of a longer word.
std::vector<std::size_t> find_words(std::string_view text, std::string_view word, bool beginning) {
  std::vector<std::size_t> found;
  for (std::size_t at = text.find(word); at != std::string_view::npos;
       at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool starts = at == 0 || !is_word_character(text[at - 1]);
    const bool ends = beginning || end == text.size() || !is_word_character(text[end]);
    if (starts && ends) found.push_back(at);
  }
  return found;
}

RetiredWord word_of(std::string cell, bool is_phrase) {
  RetiredWord word{std::move(cell), is_phrase, false};
  if (word.text.ends_with('*')) {
    word.text.pop_back();
    word.is_beginning = true;
  }
  return word;
}

/// `code` and "phrases" of a table's cell.
void add_words(std::string_view cell, std::vector<RetiredWord>& words) {
  while (!cell.empty()) {
    const std::size_t begin = cell.find_first_of("`\"");
    if (begin == std::string_view::npos) return;
    const std::size_t end = cell.find(cell[begin], begin + 1);
    if (end == std::string_view::npos) return;
    words.push_back(
        word_of(std::string(cell.substr(begin + 1, end - begin - 1)), cell[begin] == '"'));
    cell.remove_prefix(end + 1);
  }
}

bool is_searched(const fs::path& path) {
  static const std::set<std::string> endings = {".h",     ".cpp", ".md",   ".txt",
                                                ".cmake", ".in",  ".json", ""};
  const std::string name = path.generic_string();
  if (name == "docs/glossary.md" || name.ends_with("CHANGELOG.md") || name == "LICENSE")
    return false;
  return endings.contains(path.extension().string());
}

bool is_passed_over(const fs::path& folder) {
  const std::string name = folder.generic_string();
  return name == "build" || name == ".git" || name == ".cache" || name == "docs/experiments" ||
         name == "tests/fuzz/seeds" || name == "format-spec/v1/samples";
}

}  // namespace

std::vector<RetiredWord> retired_words(std::string_view glossary) {
  std::vector<RetiredWord> words;
  std::size_t at = glossary.find("\n## Retired words\n");
  while (at != std::string_view::npos) {
    const std::size_t line = at + 1;
    at = glossary.find('\n', line);
    const std::string_view row = glossary.substr(line, at - line);
    if (row.starts_with("| ")) add_words(row.substr(2, row.find('|', 2) - 2), words);
  }
  return words;
}

std::vector<std::string> uses_of(const std::vector<RetiredWord>& words, const std::string& path,
                                 std::string_view text) {
  const Flattened flat = flatten(text);
  std::vector<std::string> found;
  for (const RetiredWord& word : words) {
    if (word.is_phrase) {
      for (const std::size_t at : find_words(flat.text, word.text, false))
        found.push_back(path + ':' + std::to_string(flat.line[at]) + ": " + word.text);
      continue;
    }
    for (const std::size_t at : find_words(text, word.text, word.is_beginning))
      found.push_back(
          path + ':' +
          std::to_string(
              1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n')) +
          ": " + word.text);
  }
  return found;
}

std::vector<std::string> texts_to_search(const fs::path& root) {
  std::vector<std::string> paths;
  fs::recursive_directory_iterator entry(root);
  for (; entry != fs::recursive_directory_iterator(); ++entry) {
    const fs::path path = entry->path().lexically_relative(root);
    if (entry->is_directory()) {
      if (is_passed_over(path)) entry.disable_recursion_pending();
    } else if (entry->is_regular_file() && is_searched(path)) {
      paths.push_back(path.generic_string());
    }
  }
  std::ranges::sort(paths);
  return paths;
}

}  // namespace planetree::layering
