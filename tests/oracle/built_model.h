#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "octree/builder/job/build_options.h"
#include "planetree/model.h"
#include "planetree/probe.h"
#include "tests/oracle/brute_force.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::oracle {

using Soup = std::vector<Corners>;

/// Writes triangles as a binary PLY of doubles, three vertices each, so that
/// every coordinate arrives as it is.
void write_ply(const std::filesystem::path& path, std::span<const Corners> triangles);

struct BuildChoices {
  std::uint32_t page_bytes = 65536;  ///< smaller ones: built as large models are
  std::uint64_t budget_bytes = std::uint64_t{64} << 20;
  unsigned max_probes = 1;
  std::optional<octree::RegionBox> box = std::nullopt;  ///< build only what touches it
};

/// A .ptree file built from a soup, opened, with a probe to ask it. Everything
/// in a temporary folder that goes with it. What fails ends the test program
/// with a word.
class BuiltModel {
 public:
  explicit BuiltModel(Soup triangles, const BuildChoices& choices = {});
  /// From any mesh file; `triangles` is left empty.
  explicit BuiltModel(const std::filesystem::path& mesh, const BuildChoices& choices = {});

  [[nodiscard]] const Soup& triangles() const { return triangles_; }
  [[nodiscard]] const Model& model() const { return *model_; }
  [[nodiscard]] std::filesystem::path path() const { return folder_ / "model.ptree"; }
  /// model frame = input * 2^scale_exponent().
  [[nodiscard]] int scale_exponent() const { return scale_exponent_; }

  ClosestPoint closest_point(const Vec3& query, const QueryOptions& options = {}) {
    return probe_->closest_point(query, options);
  }
  Probe& probe() { return *probe_; }

 private:
  void build(const std::filesystem::path& mesh, const BuildChoices& choices);

  storage::TemporaryDirectory folder_;
  Soup triangles_;
  int scale_exponent_ = 0;
  std::optional<Model> model_;
  std::optional<Probe> probe_;
};

/// The error of a build that must fail, as its text; empty if it went well.
std::string build_failure(std::span<const Corners> triangles,
                          const std::optional<octree::RegionBox>& box = std::nullopt);

}  // namespace planetree::oracle
