#pragma once

#include "tools/picture/drawing.h"

namespace planetree::tools {

/// Paints a drawing into pixels, with smooth edges. The pixels depend on the drawing alone.
[[nodiscard]] PngImage paint(const Drawing& drawing);

}  // namespace planetree::tools
