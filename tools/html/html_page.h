#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace planetree::tools {

/// The figures of a point of a plot, or of a row of a table: names and values.
struct HtmlFigures {
  std::string title;
  std::vector<std::pair<std::string, std::string>> values;
};

/// A report as one HTML file. It asks for nothing outside of itself and forbids itself to. Light or
/// dark as the reader prefers.
struct HtmlPage {
  std::string kind;   ///< what is reported, above the title
  std::string title;  ///< such as the name of a file; needs no escape
  std::string body;   ///< HTML: what table_html(), plot_html() and the functions below return
  /// By key: what the page shows for a point of that PlotPoint::key when a pointer, a finger or the
  /// keyboard is on it. The row of that HtmlRow::key lights up too.
  std::map<std::string, HtmlFigures> figures;
};

/// The whole file.
[[nodiscard]] std::string page_html(const HtmlPage& page);

/// Parts of a page's body. Texts need no escape, `html` is HTML.
[[nodiscard]] std::string paragraph_html(const std::string& text);
[[nodiscard]] std::string section_html(const std::string& heading, const std::string& html);
/// Plots beside each other where the page is wide, and below each other where it is not.
[[nodiscard]] std::string row_of_plots_html(const std::string& html);
/// A cell of such a row: a plot with its own table below it.
[[nodiscard]] std::string plot_cell_html(const std::string& html);
/// Terms with their values, such as the size of a model.
[[nodiscard]] std::string facts_html(const HtmlFigures& facts);
/// A command to copy, with what it is for.
[[nodiscard]] std::string command_html(const std::string& purpose, const std::string& command);

}  // namespace planetree::tools
