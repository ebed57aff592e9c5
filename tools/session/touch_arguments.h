#pragma once

#include <cstdint>
#include <filesystem>

#include "tools/session/session_path.h"

namespace planetree::tools {

/// What `planetree touch` is told.
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

}  // namespace planetree::tools
