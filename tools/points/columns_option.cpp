#include "tools/points/columns_option.h"

#include <string>

#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::tools {
namespace {

std::string complaint_about(const std::string& text) {
  const auto columns = ColumnChoice::parse(text);
  return columns ? std::string() : "'" + octree::printable(text) + "': " + columns.error().text;
}

}  // namespace

void add_columns(SubcommandOptions& subcommand, ColumnChoice& columns) {
  subcommand.text(
      "--columns", "X,Y,Z", complaint_about,
      [&columns](const std::string& text) { columns = *ColumnChoice::parse(text); },
      "The columns of x, y and z in a text, by their names in its header or by numbers from 1. "
      "Without it a header must name x, y and z (X [m], Point_X, pos.x, Points:0 or easting, "
      "northing, height will do), and without a header they are the first three. Commas, "
      "semicolons, tabs or blanks separate columns; lines that begin with # or // are comments; "
      "numbers may have a decimal comma where that leaves no doubt");
}

}  // namespace planetree::tools
