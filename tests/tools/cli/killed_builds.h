#pragma once

#include <array>
#include <chrono>
#include <filesystem>
#include <random>
#include <string>

#include "tests/storage/file/file_image.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::tools {

/// Builds of one model by the command itself, each killed at some moment. Memory is so small that
/// all data is spilled.
class KilledBuilds {
 public:
  /// command  the program `planetree`
  /// seed     of the random moments
  KilledBuilds(std::filesystem::path command, unsigned seed);

  /// Generates the model and builds it undisturbed, with and without --resume. Returns what went
  /// wrong, empty if nothing.
  ///
  /// holes  number of triangles to leave out
  std::string prepare(const std::string& triangles, const std::string& holes);

  /// Whether the file system has files without names; on others a kill may leave a file behind.
  bool has_unnamed_files() const;

  /// Files and processes left by a killed build.
  struct Left {
    bool killed = false;    ///< killed before it was done
    bool complete = false;  ///< the destination is the complete new file
    /// A complete file has a temporary name of its own between the two calls that replace an old
    /// one.
    bool temporary_name = false;
    bool work = false;  ///< a checkpoint is left for --resume
    std::string wrong;  ///< what went wrong, in words; empty if nothing
  };
  /// Starts a build and kills it within part `which` of `parts` of a build's duration. Every other
  /// build replaces an old file.
  /// resume  keep a checkpoint; after the kill, the build is resumed and must give the same file
  /// and leave nothing beside it
  Left kill_one(unsigned which, unsigned parts, bool resume);

 private:
  int start(bool replace, bool resume) const;
  Left look(bool replace, bool resume) const;
  std::string go_on() const;

  const std::filesystem::path command_;
  std::mt19937 random_;
  storage::TemporaryDirectory models_;
  storage::TemporaryDirectory output_folder_;
  storage::TemporaryDirectory spill_folder_;
  const std::filesystem::path output_ = output_folder_ / "model.ptree";
  const storage::Bytes old_ = storage::Bytes(17, std::byte{42});
  storage::Bytes complete_;
  std::array<std::chrono::duration<double>, 2> build_times_{};  // without and with --resume
};

}  // namespace planetree::tools
