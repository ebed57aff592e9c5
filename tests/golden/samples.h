#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "octree/builder/job/region_box.h"
#include "planetree/attributes.h"
#include "planetree/layers.h"
#include "planetree/metadata.h"
#include "planetree/types.h"

/// The files in format-spec/v1/samples: each a mesh and the .ptree file built from it.
namespace planetree::golden {

struct Sample {
  const char* mesh;   ///< file name
  const char* ptree;  ///< file name
  std::uint32_t page_bytes;
  std::optional<octree::RegionBox> box = std::nullopt;  ///< region of the .ptree file, if any
  std::uint32_t keep = 0;                               ///< attributes of the .ptree file
  Metadata metadata = {};                               ///< of the .ptree file

  std::filesystem::path mesh_path() const;
  std::filesystem::path ptree_path() const;
};

/// Names a parametrised test by its sample.
std::string sample_name(const testing::TestParamInfo<Sample>& info);

const std::vector<Sample>& samples();
/// The samples that are not watertight. The caps of the sheet are one block, those of the tube have
/// nodes.
const Sample& sheet_sample();
const Sample& tube_sample();
/// The sample of a sphere, with enough triangles for several pages of 4096 bytes.
const Sample& sphere_sample();
/// The sample of a region, which samples() does not contain, and the sample of its whole mesh.
const Sample& region_sample();
const Sample& boxes_sample();
/// The sample with all attributes and with metadata, which samples() does not contain. It has two
/// attribute pages.
const Sample& painted_sample();
/// samples(), region_sample() and painted_sample().
const std::vector<Sample>& all_samples();

std::vector<std::byte> read_file(const std::filesystem::path& path);

/// The bytes of the .ptree file built from `mesh`. Throws if the build fails.
std::vector<std::byte> build_bytes(const std::filesystem::path& mesh, std::uint32_t page_bytes,
                                   unsigned threads,
                                   const std::optional<octree::RegionBox>& box = std::nullopt,
                                   std::uint32_t layers = kAllLayers, std::uint32_t keep = 0,
                                   const Metadata& metadata = {});
/// The bytes of a sample's .ptree file, built again.
std::vector<std::byte> build_bytes(const Sample& sample, unsigned threads);

/// The bytes of the file built from a sample's mesh without its first `count` triangles, and so
/// with a hole.
std::vector<std::byte> build_with_hole(const Sample& sample, std::uint64_t count);
/// The bytes of the file built from the triangles of the sphere, each a little smaller, so that
/// they do not touch each other. Its caps have several pages.
std::vector<std::byte> build_loose_sphere();

struct MeshTriangle {
  std::uint64_t id;
  std::array<Vec3, 3> corners;
};

/// The usable triangles of a mesh file, as its reader delivers them.
std::vector<MeshTriangle> mesh_triangles(const std::filesystem::path& mesh);

}  // namespace planetree::golden
