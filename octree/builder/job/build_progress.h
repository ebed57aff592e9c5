#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace planetree::octree {

/// What a build is doing.
enum class BuildPhase : std::uint8_t {
  kResuming,
  kReading,
  kOrdering,
  kClosing,
  kListing,
  kBounding,
  kColouring,
  kWriting
};

/// What a person calls it, such as "matching edges".
constexpr const char* name_of(BuildPhase phase) {
  switch (phase) {
    case BuildPhase::kResuming:
      return "taking up earlier work";
    case BuildPhase::kReading:
      return "reading";
    case BuildPhase::kOrdering:
      return "ordering";
    case BuildPhase::kClosing:
      return "matching edges";
    case BuildPhase::kListing:
      return "listing unbalanced edges";
    case BuildPhase::kBounding:
      return "bounding";
    case BuildPhase::kColouring:
      return "colouring";
    case BuildPhase::kWriting:
      break;
  }
  return "writing";
}

/// Where a build reads and writes.
enum class BuildDirectory : std::uint8_t { kInput, kTemporary, kOutput };

/// Certain how far a build is, on any thread but one at a time.
class BuildProgress {
 public:
  virtual ~BuildProgress() = default;
  /// `done` of `total` units of this phase: bytes while reading, pages while writing, parts of
  /// the model otherwise.
  virtual void progress(BuildPhase phase, std::uint64_t done, std::uint64_t total) = 0;
  /// Certain, before an error is returned, which place that is about, and its path.
  virtual void failed_at(BuildDirectory, const std::filesystem::path&) {}
  /// Certain once, of a build that keeps its work, what it goes on with, or why with nothing.
  virtual void takes_up(const std::string&) {}
};

}  // namespace planetree::octree
