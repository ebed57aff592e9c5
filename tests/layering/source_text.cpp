#include "tests/layering/source_text.h"

#include <algorithm>
#include <fstream>
#include <iterator>

namespace planetree::layering {
namespace {

namespace fs = std::filesystem;

bool is_skipped(const fs::path& folder) {
  const std::string name = folder.filename().string();
  return name.starts_with('.') || name == "build" || name.starts_with("cmake-build");
}

std::string_view without_leading_blanks(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first == std::string_view::npos ? std::string_view() : line.substr(first);
}

/// The name in `line` if it is an #include line, else an empty view.
std::string_view included_name(std::string_view line) {
  constexpr std::string_view kDirective = "include";
  line = without_leading_blanks(line);
  if (!line.starts_with('#')) return {};
  line = without_leading_blanks(line.substr(1));
  if (!line.starts_with(kDirective)) return {};
  line = without_leading_blanks(line.substr(kDirective.size()));
  if (line.empty() || (line.front() != '"' && line.front() != '<')) return {};
  const char closing = line.front() == '"' ? '"' : '>';
  return line.substr(1, line.find(closing, 1) - 1);
}

}  // namespace

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string SourceText::folder() const {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? std::string() : path.substr(0, slash + 1);
}

std::vector<SourceText> read_sources(const fs::path& root) {
  std::vector<SourceText> sources;
  fs::recursive_directory_iterator entry(root);
  for (; entry != fs::recursive_directory_iterator(); ++entry) {
    if (entry->is_directory()) {
      // Only a folder named build at the root holds build trees.
      const bool is_at_root = entry.depth() == 0;
      if (is_at_root && is_skipped(entry->path())) entry.disable_recursion_pending();
      continue;
    }
    const fs::path extension = entry->path().extension();
    if (extension != ".h" && extension != ".cpp") continue;
    sources.push_back(
        {entry->path().lexically_relative(root).generic_string(), read_text(entry->path())});
  }
  std::ranges::sort(sources, {}, &SourceText::path);
  return sources;
}

std::vector<std::string> includes_of(std::string_view text) {
  std::vector<std::string> includes;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view name = included_name(text.substr(0, end));
    if (!name.empty()) includes.emplace_back(name);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return includes;
}

bool is_standard_header(std::string_view include) {
  return include.find_first_of("/.") == std::string_view::npos;
}

}  // namespace planetree::layering
