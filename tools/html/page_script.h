#pragma once

namespace planetree::tools {

/// The script of every page: shows the figures of a point on which a pointer, a finger or the
/// keyboard is. Contents of a script element, after that of the figures.
extern const char* const kPageScript;

}  // namespace planetree::tools
