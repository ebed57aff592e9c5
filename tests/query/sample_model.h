#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "planetree/build.h"
#include "planetree/model.h"
#include "planetree/probe.h"
#include "tests/octree/support/sample_tree.h"
#include "tests/storage/system/temporary_directory.h"

/// Small models in files, with the true answers about them.
namespace planetree::query {

using octree::Soup;

/// A .ptree file of a soup in a temporary directory, and the soup itself to compare answers with. A
/// failure ends the test program with a message.
class SampleModel {
 public:
  explicit SampleModel(const Soup& soup, std::uint32_t page_bytes = 4096,
                       std::uint64_t first_index = 0);
  /// With a mask, as builds write for watertight surfaces.
  static SampleModel masked(const Soup& soup, std::uint32_t page_bytes = 4096);

  std::filesystem::path path() const { return folder_ / "model.ptree"; }
  const octree::SampleTree& sample() const { return sample_; }
  /// Number of distance pages; the pages of a mask follow them.
  std::uint32_t page_count() const { return static_cast<std::uint32_t>(sample_.plan.pages.size()); }

  /// Minimum budget that the model opens with, as the error names it.
  std::uint64_t min_budget(unsigned max_probes = 1) const;
  Model open(std::uint64_t budget_bytes = std::uint64_t{64} << 20, unsigned max_probes = 1) const;

  /// Opens a model whose batches are answered by several threads.
  Model open_for_batches(unsigned batch_threads, unsigned max_probes = 1) const;

  /// Minimum of the distances to all triangles, in model units, with the arithmetic of the library.
  double distance(const Vec3& query) const;
  std::uint64_t nearest_triangle(const Vec3& query) const;
  /// Whether [lower, upper] may hold the true distance, given its rounding error.
  bool interval_holds(const ClosestPoint& answer, const Vec3& query) const;

 private:
  Model open(const OpenOptions& options) const;
  SampleModel(const Soup& soup, std::uint32_t page_bytes, std::uint64_t first_index, bool masked);
  struct Truth {
    double distance = 0;
    double error = 0;
    std::uint64_t triangle = 0;
  };
  Truth truth(const Vec3& query) const;

  storage::TemporaryDirectory folder_;
  octree::SampleTree sample_;
};

/// Builds the .ptree file of a soup by the public interface, with pages of `page_bytes`.
void build_soup(const Soup& soup, const std::filesystem::path& path, BuildOptions options = {},
                std::uint32_t page_bytes = 4096);

Probe make_probe(const Model& model);

std::vector<Vec3> random_queries(std::size_t count, double low, double high,
                                 std::uint64_t seed = 1);

}  // namespace planetree::query
