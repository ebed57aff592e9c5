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

struct GenerateOptions {
  std::filesystem::path output;  ///< "-" is standard output
  std::uint64_t triangles = 0;
  ShapeKind shape = ShapeKind::kStatue;
  std::uint64_t seed = 1;
  bool json = false;
  bool quiet = false;
  bool force = false;
};

/// Writes the model and says on standard output what it is (on standard error if
/// the model goes to standard output). Returns the exit status.
int run_generate(const GenerateOptions& options, Console& console);

/// Adds the verb `generate` to the command line. If a person gives it, parsing
/// sets `action` to what runs it.
void add_generate(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
