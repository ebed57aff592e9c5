#include "tests/oracle/built_model.h"
#include "tests/octree/builder/silent_progress.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "octree/builder/tree_builder.h"
#include "storage/file/page_file.h"

namespace planetree::oracle {
namespace {

[[noreturn]] void give_up(const Error& error) {
  std::fprintf(stderr, "oracle: %s\n", error.text);
  std::abort();
}

template <class T>
void put(std::ofstream& file, T value) {
  file.write(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

void write_ply(const std::filesystem::path& path, std::span<const Corners> triangles) {
  std::ofstream file(path, std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << 3 * triangles.size()
       << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
       << triangles.size() << "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (const Corners& triangle : triangles)
    for (const Vec3& corner : triangle) {
      put(file, corner.x);
      put(file, corner.y);
      put(file, corner.z);
    }
  for (std::uint32_t i = 0; i < 3 * triangles.size(); i += 3) {
    put<std::uint8_t>(file, 3);
    for (std::uint32_t k = 0; k < 3; ++k) put<std::uint32_t>(file, i + k);
  }
}

BuiltModel::BuiltModel(Soup triangles, const BuildChoices& choices)
    : triangles_(std::move(triangles)) {
  const std::filesystem::path mesh = folder_ / "model.ply";
  write_ply(mesh, triangles_);
  build(mesh, choices);
  std::filesystem::remove(mesh);
}

BuiltModel::BuiltModel(const std::filesystem::path& mesh, const BuildChoices& choices) {
  build(mesh, choices);
}

void BuiltModel::build(const std::filesystem::path& mesh, const BuildChoices& choices) {
  octree::BuildOptions options;
  octree::SilentProgress silent;
  octree::BuildSeams seams;
  if (choices.page_bytes < options.page_bytes) {
    // Built as large models are: in several chunks, spilled, and with a mask of several sectors.
    seams.chunk_triangles = 60;
    seams.sector_triangles = 90;
    seams.memory = octree::BuildMemory{.threads = 2, .batch_triangles = 100};
  }
  options.page_bytes = choices.page_bytes;
  options.box = choices.box;
  options.side = choices.side;
  const auto report = octree::build_tree(mesh, path(), options, silent, seams);
  if (!report) give_up(report.error());
  record_ = report->header.model;
  OpenOptions open;
  open.memory_budget_bytes = choices.budget_bytes;
  open.max_probes = choices.max_probes;
  auto model = Model::open(path(), open);
  if (!model) give_up(model.error());
  model_.emplace(std::move(*model));
  auto probe = Probe::create(*model_);
  if (!probe) give_up(probe.error());
  probe_.emplace(std::move(*probe));
}

std::string build_failure(std::span<const Corners> triangles,
                          const std::optional<octree::RegionBox>& box) {
  const storage::TemporaryDirectory folder;
  write_ply(folder / "model.ply", triangles);
  octree::SilentProgress silent;
  octree::BuildOptions options;
  options.box = box;
  const auto report =
      octree::build_tree(folder / "model.ply", folder / "model.ptree", options, silent);
  return report ? std::string() : std::string(report.error().text);
}

}  // namespace planetree::oracle
