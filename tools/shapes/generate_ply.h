#pragma once

#include <cstdint>
#include <string_view>

#include "planetree/error.h"
#include "tools/cli/output_file.h"
#include "tools/cli/progress.h"
#include "tools/shapes/shape_model.h"

namespace planetree::tools {

/// Bytes of the file that write_ply() writes for the same arguments.
std::uint64_t ply_bytes(const Shape& shape, std::string_view comment);

/// Writes a shape as a binary little-endian PLY file: float32 x, y and z for each vertex, then a
/// count byte and three 32-bit indices for each triangle (int, or uint if an index needs the 32nd
/// bit). Uses a fixed amount of memory for shapes of any size. Does not commit `file`.
///
/// comment  one ASCII line for the header, without line end
/// errors   as OutputFile::write
Result<void> write_ply(const Shape& shape, std::string_view comment, OutputFile& file,
                       Progress& progress);

}  // namespace planetree::tools
