#pragma once

#include <filesystem>
#include <vector>

#include "planetree/error.h"
#include "storage/system/file_calls.h"

namespace planetree::octree {

/// The other files that a mesh file is read with: those of the buffers of a glTF.
///
/// return  possibly missing files; none where the mesh cannot be read.
/// errors  those of opening and reading the mesh file, other than kBadInput.
Result<std::vector<std::filesystem::path>> side_files_of(const std::filesystem::path& mesh,
                                                         storage::FileCalls& calls);

}  // namespace planetree::octree
