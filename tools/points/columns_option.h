#pragma once

#include "tools/cli/subcommand_options.h"
#include "tools/points/column_names.h"

namespace planetree::tools {

/// Declares the option --columns of a subcommand that reads a text of points.
void add_columns(SubcommandOptions& subcommand, ColumnChoice& columns);

}  // namespace planetree::tools
