#pragma once

#include <string>
#include <vector>

namespace planetree::tools {

/// A column of a table. Its texts need no escape.
struct HtmlColumn {
  /// What its values are.
  enum class Kind { kNumber, kText, kCode };

  std::string group;  ///< heading above this and its neighbours of the same group; may be empty
  std::string name;
  Kind kind = Kind::kNumber;
};

/// A row of a table. The first cell is the row's heading. Its texts need no escape.
struct HtmlRow {
  std::string key;         ///< name of what it describes, see PlotPoint::key; may be empty
  bool is_muted = false;   ///< shown in grey
  std::string muted_note;  ///< what grey means, for those who do not see it
  std::vector<std::string> cells;
};

/// A table of figures.
struct HtmlTable {
  std::string caption;
  std::vector<HtmlColumn> columns;
  std::vector<HtmlRow> rows;
};

/// The table as HTML, in a box of its own that scrolls if it is wider than the page or has many
/// rows.
[[nodiscard]] std::string table_html(const HtmlTable& table);

}  // namespace planetree::tools
