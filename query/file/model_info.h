#pragma once

#include "planetree/stats.h"
#include "storage/file/page_file.h"

namespace planetree::query {

/// Returns what a file says of its model.
ModelInfo describe(const storage::PageFile& file);

}  // namespace planetree::query
