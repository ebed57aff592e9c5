#pragma once

#include <cstdint>
#include <string_view>

#include "planetree/error.h"
#include "tools/cli/output_file.h"
#include "tools/cli/progress.h"
#include "tools/shapes/shape_model.h"

namespace planetree::tools {

/// Bytes of the file that write_ply makes of the same arguments.
std::uint64_t ply_bytes(const Shape& shape, std::string_view comment);

/// Writes a shape as a binary little-endian PLY file: float32 x, y, z of every
/// vertex, then of every triangle a count byte and three 32-bit indices (int, or
/// uint when some index needs the 32nd bit). Takes a fixed amount of memory,
/// whatever the size of the shape. Does not commit `file`.
///
/// comment  one ASCII line of the header, without line end
/// errors   those of OutputFile::write
Result<void> write_ply(const Shape& shape, std::string_view comment, OutputFile& file,
                       Progress& progress);

}  // namespace planetree::tools
