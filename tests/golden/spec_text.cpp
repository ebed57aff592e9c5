#include "tests/golden/spec_text.h"

#include <algorithm>
#include <fstream>
#include <regex>
#include <stdexcept>

namespace planetree::golden {
namespace {

const std::vector<std::string>& lines() {
  static const std::vector<std::string> all = [] {
    std::ifstream stream(PLANETREE_SOURCE_DIR "/format-spec/v1/spec.md");
    std::vector<std::string> read;
    for (std::string line; std::getline(stream, line);) read.push_back(line);
    return read;
  }();
  return all;
}

// Returns 0 for a line that is no heading.
std::size_t heading_depth(const std::string& line) {
  const std::size_t depth = line.find_first_not_of('#');
  return depth != std::string::npos && line[depth] == ' ' ? depth : 0;
}

// The title without number: "## 2.1 Header" gives Header, "### B.3 Scale" gives Scale, "## Appendix
// B: Notes" gives Notes.
std::string title_of(const std::string& line) {
  static const std::regex number(R"(^#+ (?:\d+(?:\.\d+)* |[A-Z](?:\.\d+)+ |Appendix [A-Z]: )?)");
  return std::regex_replace(line, number, "");
}

std::vector<std::string> section(const std::string& heading) {
  auto begin = std::ranges::find_if(lines(), [&](const std::string& line) {
    return heading_depth(line) > 0 && title_of(line) == heading;
  });
  if (begin == lines().end()) throw std::runtime_error("no section " + heading);
  const std::size_t depth = heading_depth(*begin++);
  const auto end = std::find_if(begin, lines().end(), [&](const std::string& line) {
    return heading_depth(line) > 0 && heading_depth(line) <= depth;
  });
  return {begin, end};
}

std::string trimmed(std::string cell) {
  std::erase(cell, '`');
  const std::size_t first = cell.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return cell.substr(first, cell.find_last_not_of(' ') + 1 - first);
}

// "| a | b |" gives a and b.
TableRow cells_of(const std::string& line) {
  TableRow cells;
  for (std::size_t bar = 0; bar + 1 < line.size();) {
    const std::size_t next = std::min(line.find('|', bar + 1), line.size());
    cells.push_back(trimmed(line.substr(bar + 1, next - bar - 1)));
    bar = next;
  }
  return cells;
}

}  // namespace

std::vector<std::string> SpecTable::column(const std::string& head) const {
  const auto at = static_cast<std::size_t>(std::ranges::find(heads, head) - heads.begin());
  std::vector<std::string> cells;
  for (const TableRow& row : rows) cells.push_back(row.at(at));
  return cells;
}

std::vector<SpecTable> spec_tables(const std::string& heading) {
  std::vector<SpecTable> tables;
  bool inside = false;
  for (const std::string& line : section(heading)) {
    const bool is_row = line.starts_with('|');
    if (is_row && !inside)
      tables.push_back({cells_of(line), {}});
    else if (is_row && !line.starts_with("|---"))
      tables.back().rows.push_back(cells_of(line));
    inside = is_row;
  }
  return tables;
}

std::string spec_block(const std::string& word) {
  const auto fence = std::ranges::find(lines(), "```" + word);
  if (fence == lines().end()) throw std::runtime_error("no block " + word);
  std::string block;
  for (auto line = fence + 1; line != lines().end() && *line != "```"; ++line)
    block += *line + "\n";
  return block;
}

}  // namespace planetree::golden
