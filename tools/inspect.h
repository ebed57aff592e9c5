#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "planetree/types.h"
#include "tools/cli/file_text.h"
#include "tools/cli/subcommand.h"
#include "tools/report/slice_image.h"

namespace CLI {
class App;
}

namespace planetree::tools {

struct InspectArguments {
  std::filesystem::path file;
  bool levels = false;
  bool pages = false;
  std::optional<OctcodeQuery> node;
  std::optional<std::uint64_t> page;
  std::optional<SlicePlane> slice;
  std::optional<Vec3> why;
  std::filesystem::path image;
  bool replace_image = false;
  bool json = false;
  bool quiet = false;
};

/// Says what is in a file; writes nothing but the image. Returns the exit
/// status: 1 if a part of the file cannot be read.
int run_inspect(const InspectArguments& arguments, Console& console);

/// Adds the verb `inspect` to the command line. If a person gives it, parsing
/// sets `action` to what runs it.
void add_inspect(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
