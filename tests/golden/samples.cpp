#include "tests/golden/samples.h"

#include <fstream>
#include <iomanip>
#include <stdexcept>

#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/tree_builder.h"
#include "tests/octree/builder/silent_progress.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::golden {
namespace {

const std::filesystem::path kFolder = PLANETREE_SOURCE_DIR "/format-spec/v1/samples";

class Collector final : public octree::TriangleSink {
 public:
  Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) override {
    found.push_back({index, corners});
    return {};
  }
  void skipped(std::uint64_t, std::uint64_t, const octree::SkippedRecord&) override {}
  Result<void> progress(std::uint64_t, std::uint64_t) override { return {}; }

  std::vector<MeshTriangle> found;
};

// Builds a file of triangles that share no vertex records, with pages of 4096 bytes.
std::vector<std::byte> build_triangles(const std::vector<MeshTriangle>& triangles) {
  const storage::TemporaryDirectory folder;
  std::ofstream mesh(folder / "mesh.obj");
  mesh << std::setprecision(17);
  for (const MeshTriangle& triangle : triangles) {
    for (const Vec3& corner : triangle.corners)
      mesh << "v " << corner.x << ' ' << corner.y << ' ' << corner.z << '\n';
    mesh << "f -3 -2 -1\n";
  }
  mesh.close();
  return build_bytes(folder / "mesh.obj", 4096, 1);
}

}  // namespace

std::filesystem::path Sample::mesh_path() const { return kFolder / mesh; }
std::filesystem::path Sample::ptree_path() const { return kFolder / ptree; }

std::string sample_name(const testing::TestParamInfo<Sample>& info) {
  return std::filesystem::path(info.param.ptree).stem();
}

const std::vector<Sample>& samples() {
  static const std::vector<Sample> all = {
      {"tetrahedron.ply", "tetrahedron.ptree", 4096},
      {"sheet.obj", "sheet.ptree", 4096},
      {"sphere.ply", "sphere.ptree", 4096},
      {"boxes.obj", "boxes.ptree", 4096},
      {"tube.obj", "tube.ptree", 4096},
  };
  return all;
}

const Sample& sheet_sample() { return samples()[1]; }
const Sample& sphere_sample() { return samples()[2]; }
const Sample& boxes_sample() { return samples()[3]; }
const Sample& tube_sample() { return samples()[4]; }

const Sample& region_sample() {
  static const Sample sample = {"boxes.obj", "region.ptree", 4096,
                                octree::RegionBox{{11.5, -14, 0}, {26, 14, 14}}};
  return sample;
}

const Sample& painted_sample() {
  static const Sample sample = {
      "painted.ply",
      "painted.ptree",
      4096,
      std::nullopt,
      kAllAttributes,
      {{"crs", "EPSG:25832"}, {"unit", "mm"}, {"up", "z"}, {"title", "Drum \u00d8 2 mm"}}};
  return sample;
}

const std::vector<Sample>& all_samples() {
  static const std::vector<Sample> all = [] {
    std::vector<Sample> listed = samples();
    listed.insert(listed.end(), {region_sample(), painted_sample()});
    return listed;
  }();
  return all;
}

std::vector<std::byte> read_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + path.string());
  std::vector<std::byte> bytes(std::filesystem::file_size(path));
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

std::vector<std::byte> build_bytes(const std::filesystem::path& mesh, std::uint32_t page_bytes,
                                   unsigned threads, const std::optional<octree::RegionBox>& box,
                                   std::uint32_t layers, std::uint32_t keep,
                                   const Metadata& metadata) {
  const storage::TemporaryDirectory folder;
  octree::BuildOptions options;
  options.page_bytes = page_bytes;
  options.threads = threads;
  options.box = box;
  options.layers = layers;
  options.keep = keep;
  options.metadata = metadata;
  octree::SilentProgress silence;
  const auto report = octree::build_tree(mesh, folder / "built.ptree", options, silence);
  if (!report) throw std::runtime_error(report.error().text);
  return read_file(folder / "built.ptree");
}

std::vector<std::byte> build_bytes(const Sample& sample, unsigned threads) {
  return build_bytes(sample.mesh_path(), sample.page_bytes, threads, sample.box, kAllLayers,
                     sample.keep, sample.metadata);
}

std::vector<std::byte> build_with_hole(const Sample& sample, std::uint64_t count) {
  std::vector<MeshTriangle> triangles = mesh_triangles(sample.mesh_path());
  std::erase_if(triangles, [count](const MeshTriangle& triangle) { return triangle.id < count; });
  return build_triangles(triangles);
}

std::vector<std::byte> build_loose_sphere() {
  std::vector<MeshTriangle> triangles = mesh_triangles(sphere_sample().mesh_path());
  for (MeshTriangle& triangle : triangles) {
    const auto [a, b, c] = triangle.corners;
    const Vec3 sum = {a.x + b.x + c.x, a.y + b.y + c.y, a.z + b.z + c.z};
    for (Vec3& corner : triangle.corners)
      corner = {corner.x + (sum.x / 3 - corner.x) / 16, corner.y + (sum.y / 3 - corner.y) / 16,
                corner.z + (sum.z / 3 - corner.z) / 16};
  }
  return build_triangles(triangles);
}

std::vector<MeshTriangle> mesh_triangles(const std::filesystem::path& mesh) {
  Collector collector;
  const auto read = octree::read_mesh(mesh, collector);
  if (!read) throw std::runtime_error(read.error().text);
  return std::move(collector.found);
}

}  // namespace planetree::golden
