#pragma once

#include <string>

#include "tools/trace_file/prefetch_figures.h"

namespace planetree::tools {

/// A section of a page: how good the pages were that were read for a motion.
[[nodiscard]] std::string prefetch_section(const PrefetchFigures& figures);

}  // namespace planetree::tools
