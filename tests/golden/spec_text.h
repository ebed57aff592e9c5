#pragma once

#include <string>
#include <vector>

/// Tables and code blocks of format-spec/v1/spec.md.
namespace planetree::golden {

using TableRow = std::vector<std::string>;

/// A table of the specification. Cells are without backticks and outer spaces.
struct SpecTable {
  TableRow heads;
  std::vector<TableRow> rows;

  /// The cells below the given head.
  std::vector<std::string> column(const std::string& head) const;
};

/// The tables under a heading and its subsections, in order.
///
/// heading  title of the section without its number.
std::vector<SpecTable> spec_tables(const std::string& heading);

/// The lines of the only code block with the info string `word`.
std::string spec_block(const std::string& word);

}  // namespace planetree::golden
