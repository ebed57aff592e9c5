#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "planetree/build.h"
#include "planetree/error.h"

namespace planetree::octree {

using planetree::BuildPhase;
using planetree::name_of;

/// The directories that a build reads or writes.
enum class BuildDirectory : std::uint8_t { kInput, kTemporary, kOutput };

/// Receives the progress of a build. Calls come from any thread, one at a time.
class BuildProgress {
 public:
  virtual ~BuildProgress() = default;
  /// Reports `done` of `total` units of a phase: bytes while reading, pages while writing, parts of
  /// the model otherwise. An error ends the build and is returned from it.
  virtual Result<void> progress(BuildPhase phase, std::uint64_t done, std::uint64_t total) = 0;
  /// Reports, before an error is returned, which directory the error concerns, and the path.
  virtual void failed_at(BuildDirectory, const std::filesystem::path&) {}
  /// Reports once, for a build with a checkpoint, what work it resumes, or why it resumes none.
  virtual void resumes(const std::string&) {}
};

}  // namespace planetree::octree
