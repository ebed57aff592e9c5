#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "planetree/types.h"
#include "tools/cli/file_text.h"
#include "tools/cli/open_model.h"
#include "tools/cli/report_page.h"
#include "tools/cli/subcommand.h"
#include "tools/report/show_bounds.h"
#include "tools/slice/slice_arguments.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Arguments of `planetree inspect`.
struct InspectArguments {
  std::filesystem::path file;
  bool levels = false;
  bool pages = false;
  std::optional<OctcodeQuery> node;
  std::optional<std::uint64_t> page;
  SliceArguments slice;    ///< if it has a plane; `file`, `json` and `quiet` are those of this
  BoundsArguments bounds;  ///< likewise, if it has an output
  std::optional<Vec3> why;
  SourceChoice source;  ///< for a URL or a set
  PageChoice html;      ///< page to write; --force is also for the picture and the bounds
  bool json = false;
  bool quiet = false;
};

/// Reports the contents of a file, also of a damaged one. Writes nothing but a picture, bounds or a
/// page. Returns the exit status, 1 if the file has an issue or pages could not be read.
int run_inspect(const InspectArguments& arguments, Console& console);

/// Adds the subcommand `inspect` to the command line. If it is given, parsing sets `action` to a
/// call of run_inspect().
void add_inspect(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
