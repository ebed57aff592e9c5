#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "tools/touch_path.h"
#include "tools/verb.h"

namespace CLI {
class App;
}

namespace planetree::tools {

struct TouchArguments {
  std::filesystem::path file;
  std::uint64_t seconds = 10;
  std::uint64_t rate_hz = 1000;
  std::uint64_t memory_bytes = std::uint64_t{256} << 20;
  TouchMotion motion = TouchMotion::kGlide;
  std::filesystem::path ticks;  ///< where every tick is written; empty: nowhere
  std::filesystem::path trace;  ///< the same of every page that is looked for
  bool force = false;           ///< existing ones may be replaced
  bool cold = false;            ///< the system is to forget what it has of the file in memory
  bool json = false;
};

/// Holds a simulated haptic session and reports how late and how certain its answers were.
/// Returns the exit status.
int run_touch(const TouchArguments& arguments, Console& console);

/// Adds the verb `touch` to the command line. If a person gives it, parsing
/// sets `action` to what runs it.
void add_touch(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
