#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "planetree/types.h"
#include "tools/answers/answer_writer.h"
#include "tools/cli/subcommand.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Arguments of `planetree scene`.
struct SceneArguments {
  std::filesystem::path file;
  std::optional<std::filesystem::path> points;  ///< empty: report the scene; "-": standard input
  std::filesystem::path output = "-";
  bool force = false;
  std::optional<std::uint64_t> memory_bytes;  ///< empty: as the scene file says
  QueryOptions options;
  AnswerForm form;
  bool json = false;
  bool quiet = false;
};

/// Opens a scene, and reports what its models take, or answers points. Returns the exit status.
int run_scene(const SceneArguments& arguments, Console& console);

/// Adds the subcommand `scene` to the command line. If it is given, parsing sets `action` to a call
/// of run_scene().
void add_scene(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
