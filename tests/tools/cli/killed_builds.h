#pragma once

#include <array>
#include <chrono>
#include <filesystem>
#include <random>
#include <string>

#include "tests/storage/file/file_image.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::tools {

/// Builds of one model by the command itself, with so little memory that all is spilled, each
/// killed at some moment.
class KilledBuilds {
 public:
  /// command  the program `planetree`.
  /// seed     of the moments.
  KilledBuilds(std::filesystem::path command, unsigned seed);

  /// Generates the model and builds it undisturbed, with and without --resume. What went wrong,
  /// if anything.
  std::string prepare(const std::string& triangles);

  /// Where files have no names before they are complete; elsewhere a kill may leave one.
  bool has_unnamed_files() const;

  /// What a killed build left.
  struct Left {
    bool killed = false;  ///< it was not done before
    bool whole = false;   ///< the destination is the new file
    /// Between the two calls by which a file that is complete replaces another, it has a name
    /// of its own.
    bool temporary_name = false;
    bool work = false;  ///< there is work that --resume goes on with
    std::string wrong;  ///< in words; empty if nothing is
  };
  /// Starts a build and kills it within part `which` of `parts` of the time that one takes.
  /// Every other one is to replace an old file.
  /// resume  it keeps its work; once killed it is built again, and must come to the same file and
  ///         leave nothing beside it.
  Left strike(unsigned which, unsigned parts, bool resume);

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
  storage::Bytes whole_;
  std::array<std::chrono::duration<double>, 2> build_times_{};  // without and with --resume
};

}  // namespace planetree::tools
