#pragma once

namespace planetree::tools {

/// The style of every page, as contents of a style element.
extern const char* const kPageStyle;

}  // namespace planetree::tools
