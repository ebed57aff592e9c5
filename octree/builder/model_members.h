#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "octree/builder/job/build_options.h"
#include "octree/builder/job/model_frame.h"
#include "octree/builder/tree/tree_pages.h"
#include "planetree/error.h"
#include "storage/file/model_output.h"
#include "storage/system/file_calls.h"

namespace planetree::octree {

/// What the members of a set are described by. References must outlive the output.
struct ModelMembers {
  const ModelFrame& frame;
  const TreePages& pages;
  std::uint32_t page_count = 0;  ///< of all kinds
};

/// Starts the output of a build: a file, or a set if options.member_bytes is not 0.
///
/// errors  those of storage::new_model_file() or storage::NewSet::create()
Result<std::unique_ptr<storage::ModelOutput>> create_output(const ModelMembers& members,
                                                            const std::filesystem::path& output,
                                                            const BuildOptions& options,
                                                            storage::FileCalls& calls);

}  // namespace planetree::octree
