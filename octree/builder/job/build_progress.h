#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace planetree::octree {

/// Phases of a build, in order.
enum class BuildPhase : std::uint8_t {
  kResuming,
  kReading,
  kOrdering,
  kMatching,
  kListing,
  kBuildingTree,
  kBuildingMask,
  kWriting
};

/// Name of a phase for messages, such as "matching edges".
constexpr const char* name_of(BuildPhase phase) {
  switch (phase) {
    case BuildPhase::kResuming:
      return "resuming";
    case BuildPhase::kReading:
      return "reading";
    case BuildPhase::kOrdering:
      return "ordering";
    case BuildPhase::kMatching:
      return "matching edges";
    case BuildPhase::kListing:
      return "listing unbalanced edges";
    case BuildPhase::kBuildingTree:
      return "building tree";
    case BuildPhase::kBuildingMask:
      return "building mask";
    case BuildPhase::kWriting:
      break;
  }
  return "writing";
}

/// The directories that a build reads or writes.
enum class BuildDirectory : std::uint8_t { kInput, kTemporary, kOutput };

/// Receives the progress of a build. Calls come from any thread, one at a time.
class BuildProgress {
 public:
  virtual ~BuildProgress() = default;
  /// Reports `done` of `total` units of a phase: bytes while reading, pages while writing, parts of
  /// the model otherwise.
  virtual void progress(BuildPhase phase, std::uint64_t done, std::uint64_t total) = 0;
  /// Reports, before an error is returned, which directory the error concerns, and the path.
  virtual void failed_at(BuildDirectory, const std::filesystem::path&) {}
  /// Reports once, for a build with a checkpoint, what work it resumes, or why it resumes none.
  virtual void resumes(const std::string&) {}
};

}  // namespace planetree::octree
