#pragma once

#include <filesystem>

#include "planetree/build.h"
#include "planetree/error.h"
#include "tools/build/build_meter.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {

/// What a build reads and writes.
struct BuildFiles {
  const std::filesystem::path& input;  ///< the mesh, or the job
  const std::filesystem::path& output;
};

/// Reports a build that has ended: its error, or warnings and then one line of text or of JSON,
/// which has the SHA-256 of the file, or of the joined members of a set. Returns the exit status.
int report_build(const Result<BuildReport>& built, BuildMeter& meter, const BuildFiles& files,
                 bool json, Console& console);

}  // namespace planetree::tools
