#pragma once

#include <filesystem>

#include "planetree/error.h"

namespace planetree::tools {

/// Returns the median length of a model's edges, model units, from a sample of the file's pages; 0
/// if no page of the sample can be read. It is a scale of the model's detail: a tolerance far below
/// it is finer than the mesh.
///
/// errors  as FileParts::open(); kBadInput: the file has no valid header
Result<double> median_edge(const std::filesystem::path& path);

}  // namespace planetree::tools
