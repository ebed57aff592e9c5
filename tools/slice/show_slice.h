#pragma once

#include "tools/cli/subcommand.h"
#include "tools/slice/slice_arguments.h"

namespace planetree::tools {

/// Draws a slice and writes the picture. `arguments.plane` is given. Returns the exit status.
int show_slice(const SliceArguments& arguments, Console& console);

}  // namespace planetree::tools
