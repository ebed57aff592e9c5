#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "planetree/build.h"
#include "tools/cli/progress.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {

/// Shows the progress of a build, or of a part of one. Records the time of each phase and the file
/// of a failure.
class BuildMeter {
 public:
  /// name  what is built, for messages.
  BuildMeter(const std::filesystem::path& name, bool quiet, bool json, Console& console)
      : name_(name), quiet_(quiet), console_(console), progress_(quiet, json) {}

  /// The options of the build, with this as observer. This must outlive them.
  BuildOptions observed(BuildOptions options);
  /// Ends the last phase.
  void finish();

  /// Seconds by phase, in the order of phases.
  const nlohmann::ordered_json& seconds_by_phase() const { return seconds_; }
  /// Seconds since this was made; above 0.
  double seconds() const;
  const std::filesystem::path& failed_at() const { return failed_at_; }

 private:
  void show(BuildPhase phase, std::uint64_t done, std::uint64_t total);
  void note_seconds();

  const std::filesystem::path& name_;
  const bool quiet_;
  Console& console_;
  Progress progress_;
  std::filesystem::path failed_at_;
  std::optional<BuildPhase> phase_;
  const std::chrono::steady_clock::time_point made_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point started_ = made_;
  nlohmann::ordered_json seconds_ = nlohmann::ordered_json::object();
  std::uint64_t done_ = 0;
};

/// The name of a mesh in messages: the path of its file, or "3 meshes" for several.
std::string mesh_name(const std::vector<std::filesystem::path>& files);
/// What an error concerns, for messages: a path, or several meshes as a whole.
std::string name_of_failure(const BuildMeter& meter,
                            const std::vector<std::filesystem::path>& inputs);

/// Warns of what a build reports of its mesh: notes, skipped records, odd polygons.
/// mesh  as mesh_name().
void warn_of_mesh(const std::string& mesh, const BuildReport& report, Console& console);

}  // namespace planetree::tools
