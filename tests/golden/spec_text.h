#pragma once

#include <string>
#include <vector>

/// format-spec/v1/spec.md, taken apart.
namespace planetree::golden {

using TableRow = std::vector<std::string>;

/// A table of the specification: cells without backticks and outer spaces.
struct SpecTable {
  TableRow heads;
  std::vector<TableRow> rows;

  /// The cells below one head.
  std::vector<std::string> column(const std::string& head) const;
};

/// The tables under a heading, in their order, those of its subsections included.
/// heading  without its number.
std::vector<SpecTable> spec_tables(const std::string& heading);

/// The lines of the only block fenced with this word.
std::string spec_block(const std::string& word);

}  // namespace planetree::golden
