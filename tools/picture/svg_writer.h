#pragma once

#include <string>

#include "planetree/error.h"
#include "tools/picture/drawing.h"

namespace planetree::tools {

/// The drawing as an SVG file that needs no other file. Text is text, rasters are PNG files within
/// it, and the metadata is in the element `metadata`.
///
/// errors  kNoMemory
Result<std::string> svg_text(const Drawing& drawing);

}  // namespace planetree::tools
