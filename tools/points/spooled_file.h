#pragma once

#include "octree/builder/mesh/stream/mesh_file.h"
#include "planetree/error.h"
#include "tools/cli/input_file.h"

namespace planetree::tools {

/// Copies a stream to a temporary file without a name, which may be read at any offset. The file is
/// in the system's directory for temporary files and vanishes with the process.
///
/// errors  as storage::file_error()
Result<octree::MeshFile> spool(InputFile& stream);

}  // namespace planetree::tools
