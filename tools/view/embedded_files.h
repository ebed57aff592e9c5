#pragma once

#include <span>

#include "tools/view/view_router.h"

namespace planetree::tools {

/// The files of the page, which are part of the program. `three.module.js` is among them if the
/// program was built with three.js. embedded_files.cmake writes the definition.
std::span<const PageFile> embedded_files();

}  // namespace planetree::tools
