#include "tests/layering/document_text.h"

#include "tests/layering/source_text.h"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace planetree::layering {
namespace {

namespace fs = std::filesystem;

bool is_alphanumeric(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }
bool is_word(char c) { return is_alphanumeric(c) || c == '_'; }

bool ends_with_any(std::string_view text, std::initializer_list<std::string_view> endings) {
  return std::ranges::any_of(endings, [text](std::string_view end) { return text.ends_with(end); });
}

std::string without_fenced_blocks(const std::string& text) {
  std::istringstream lines(text);
  std::string kept;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    const bool is_fence = line.starts_with("```");
    if (!inside && !is_fence) kept += line + '\n';
    inside ^= is_fence;
  }
  return kept;
}

/// The anchor of a heading: small letters, digits, '_' and '-'; a '-' for each blank.
std::string anchor_of(std::string_view heading) {
  std::string anchor;
  for (const char c : heading) {
    if (c == ' ') anchor += '-';
    if (is_word(c) || c == '-')
      anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return anchor;
}

/// Calls visit(path) for each file and folder, from the root. Build trees are skipped.
template <class Visit>
void for_each_path(const fs::path& root, const Visit& visit) {
  fs::recursive_directory_iterator entry(root);
  for (; entry != fs::recursive_directory_iterator(); ++entry) {
    const std::string name = entry->path().filename().string();
    const bool is_skipped = name.starts_with('.') || name == "build";
    if (entry.depth() == 0 && is_skipped) {
      if (entry->is_directory()) entry.disable_recursion_pending();
      continue;
    }
    visit(entry->path().lexically_relative(root).generic_string());
  }
}

void add_words(std::string_view text, std::set<std::string>& words) {
  while (!text.empty()) {
    const auto end = std::ranges::find_if_not(text, is_word);
    const auto length = static_cast<std::size_t>(end - text.begin());
    if (length > 0) words.emplace(text.substr(0, length));
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
}

}  // namespace

std::vector<std::string> Document::links() const {
  std::vector<std::string> found;
  for (std::size_t at = text.find("]("); at != std::string::npos; at = text.find("](", at + 1)) {
    const std::string target = text.substr(at + 2, text.find(')', at) - at - 2);
    if (target.find("://") == std::string::npos && !target.starts_with("mailto:"))
      found.push_back(target);
  }
  return found;
}

std::vector<std::string> Document::code_spans() const {
  std::vector<std::string> found;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    for (std::size_t at = line.find('`'); at != std::string::npos;) {
      const std::size_t end = line.find('`', at + 1);
      if (end == std::string::npos) break;
      found.push_back(line.substr(at + 1, end - at - 1));
      at = line.find('`', end + 1);
    }
  }
  return found;
}

std::set<std::string> Document::anchors() const {
  std::set<std::string> found;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find_first_not_of('#');
    if (first > 0 && first != std::string::npos && line[first] == ' ')
      found.insert(anchor_of(std::string_view(line).substr(first + 1)));
  }
  return found;
}

bool KnownNames::has_path(std::string_view path) const {
  if (path.ends_with('/')) path.remove_suffix(1);
  return std::ranges::any_of(paths, [path](std::string_view known) {
    return known.ends_with(path) &&
           (known.size() == path.size() || known[known.size() - path.size() - 1] == '/');
  });
}

std::vector<Document> read_documents(const fs::path& root) {
  std::vector<Document> documents;
  for_each_path(root, [&](const std::string& path) {
    if (path.ends_with(".md"))
      documents.push_back({path, without_fenced_blocks(read_text(root / path))});
  });
  std::ranges::sort(documents, {}, &Document::path);
  return documents;
}

KnownNames read_known_names(const fs::path& root) {
  KnownNames known;
  for_each_path(root, [&](const std::string& path) {
    known.paths.insert(path);
    const bool is_script = path.find('.') == std::string::npos && fs::is_regular_file(root / path);
    if (is_script || ends_with_any(path, {".h", ".cpp", ".py", ".cmake", ".txt", ".json"}))
      add_words(read_text(root / path), known.words);
  });
  return known;
}

bool is_path(std::string_view span, const KnownNames& known) {
  const auto is_path_character = [](char c) {
    return is_word(c) || c == '.' || c == '-' || c == '/';
  };
  if (!std::ranges::all_of(span, is_path_character)) return false;
  if (span.starts_with("build/") || span.starts_with("./") || span.starts_with('-')) return false;
  if (span.ends_with('/') || ends_with_any(span, {".h", ".cpp", ".md", ".cmake", ".png"}))
    return true;
  const std::size_t slash = span.find('/');
  return slash != std::string_view::npos &&
         known.paths.contains(std::string(span.substr(0, slash)));
}

std::vector<std::string> identifier_words(std::string_view span) {
  const bool is_call = span.ends_with("()");
  if (is_call) span.remove_suffix(2);
  const bool has_colons = span.find("::") != std::string_view::npos;
  const auto is_allowed = [](char c) { return is_word(c) || c == ':'; };
  const auto is_special = [](char c) {
    return c == '_' || std::isupper(static_cast<unsigned char>(c)) != 0;
  };
  if (span.empty() || std::isdigit(static_cast<unsigned char>(span.front())) != 0) return {};
  if (!std::ranges::all_of(span, is_allowed)) return {};
  if (!is_call && !has_colons && std::ranges::none_of(span, is_special)) return {};
  std::set<std::string> words;
  add_words(span, words);
  return {words.begin(), words.end()};
}

}  // namespace planetree::layering
