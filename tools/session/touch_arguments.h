#pragma once

#include <cstdint>
#include <filesystem>

#include "planetree/layers.h"
#include "planetree/model.h"
#include "tools/cli/open_model.h"
#include "tools/cli/report_page.h"
#include "tools/session/session_path.h"

namespace planetree::tools {

/// Arguments of `planetree touch`.
struct TouchArguments {
  std::filesystem::path file;  ///< the model or, if is_scene, the scene file
  bool is_scene = false;
  std::uint64_t seconds = 10;
  std::uint64_t rate_hz = 1000;
  std::uint64_t memory_bytes = std::uint64_t{256} << 20;
  bool memory_is_given = false;
  std::uint32_t layers = kAllLayers;             ///< layers to open
  EvictionPolicy policy = OpenOptions{}.policy;  ///< how the page to evict is chosen
  TouchMotion motion = TouchMotion::kGlide;
  double radius = 0;            ///< of a ball as tool, model units; 0: a point
  std::filesystem::path ticks;  ///< file for all ticks; empty: none
  std::filesystem::path trace;  ///< file for the page trace; empty: none
  std::uint64_t seed = kTouchSeed;
  bool latency_is_given = false;
  bool is_deterministic = false;      ///< simulate disk and clock
  std::uint64_t latency_ns = 85'000;  ///< of the simulated disk, for a page
  PageChoice page;                    ///< page to write, and whether files may be replaced
  bool cold = false;                  ///< drop the file from the system's page cache first
  bool no_io_uring = false;
  SourceChoice source;      ///< for a URL or a set
  bool read_ahead = false;  ///< OpenOptions::read_ahead of the session
  bool json = false;
};

}  // namespace planetree::tools
