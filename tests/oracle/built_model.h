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
#include "storage/file/file_layout.h"
#include "tests/oracle/brute_force.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::oracle {

using Soup = std::vector<Corners>;

/// Writes triangles as a binary PLY of doubles, with three vertices for each triangle. Every
/// coordinate keeps its bits.
void write_ply(const std::filesystem::path& path, std::span<const Corners> triangles);

struct BuildChoices {
  std::uint32_t page_bytes = 65536;  ///< below the default: built as large models are
  std::uint64_t budget_bytes = std::uint64_t{64} << 20;
  unsigned max_probes = 1;
  std::optional<octree::RegionBox> box = std::nullopt;  ///< build only triangles that touch it
  /// How sides are decided by default; empty: as the builder finds.
  std::optional<storage::SideRule> side = storage::SideRule::kSolid;
};

/// A .ptree file built from a soup, opened, with a probe to query it. All files are in a temporary
/// directory that this owns. A failure ends the test program with a message.
class BuiltModel {
 public:
  explicit BuiltModel(Soup triangles, const BuildChoices& choices = {});
  /// Builds from any mesh file; triangles() is empty then.
  explicit BuiltModel(const std::filesystem::path& mesh, const BuildChoices& choices = {});

  [[nodiscard]] const Soup& triangles() const { return triangles_; }
  [[nodiscard]] const Model& model() const { return *model_; }
  [[nodiscard]] std::filesystem::path path() const { return folder_ / "model.ptree"; }
  /// model frame = input * 2^scale_exponent()
  [[nodiscard]] int scale_exponent() const { return record_.scale_exponent; }
  [[nodiscard]] const storage::ModelRecord& record() const { return record_; }

  ClosestPoint closest_point(const Vec3& query, const QueryOptions& options = {}) {
    return probe_->closest_point(query, options);
  }
  Probe& probe() { return *probe_; }

 private:
  void build(const std::filesystem::path& mesh, const BuildChoices& choices);

  storage::TemporaryDirectory folder_;
  Soup triangles_;
  storage::ModelRecord record_{};
  std::optional<Model> model_;
  std::optional<Probe> probe_;
};

/// Text of the error of a build that must fail; empty if the build succeeds.
std::string build_failure(std::span<const Corners> triangles,
                          const std::optional<octree::RegionBox>& box = std::nullopt);

}  // namespace planetree::oracle
