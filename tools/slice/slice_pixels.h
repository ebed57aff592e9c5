#pragma once

#include "tools/slice/slice_picture.h"

namespace planetree::tools {

/// The pixels of the plane: bands of colour, or the pages there, with iso-lines and the surface,
/// which is dark. Every fifth iso-line is stronger.
[[nodiscard]] PngImage slice_pixels(const SliceContents& contents);

}  // namespace planetree::tools
