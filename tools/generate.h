#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "tools/cli/subcommand.h"
#include "tools/shapes/shape_model.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Arguments of `planetree generate`.
struct GenerateOptions {
  std::filesystem::path output;  ///< "-" is standard output
  std::uint64_t triangles = 0;
  ShapeKind shape = ShapeKind::kStatue;
  std::uint64_t seed = 1;
  std::uint64_t holes = 0;  ///< triangles to leave out
  bool json = false;
  bool quiet = false;
  bool force = false;
};

/// Writes the model and reports it on standard output, or on standard error if the model goes to
/// standard output. Returns the exit status.
int run_generate(const GenerateOptions& options, Console& console);

/// Adds the subcommand `generate` to the command line. If it is given, parsing sets `action` to a
/// call of run_generate().
void add_generate(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
