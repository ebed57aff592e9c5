#pragma once

#include <filesystem>
#include <vector>

#include "planetree/build.h"
#include "planetree/error.h"
#include "tools/build/build_meter.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {

/// What a build reads and writes.
struct BuildFiles {
  const std::vector<std::filesystem::path>& inputs;  ///< the files of the mesh, or the job
  const std::filesystem::path& output;
};

/// Reports a build that has ended: its error, or warnings and then one line of text or of JSON,
/// which has the SHA-256 of the file. Returns the exit status.
int report_build(const Result<BuildReport>& built, BuildMeter& meter, const BuildFiles& files,
                 bool json, Console& console);

}  // namespace planetree::tools
