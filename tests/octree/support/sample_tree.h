#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "octree/builder/job/model_frame.h"
#include "octree/builder/mask/mask_build.h"
#include "octree/builder/sort/morton_order.h"
#include "octree/builder/sort/triangle_runs.h"
#include "octree/builder/surface/edge_balance.h"
#include "octree/builder/tree/binary_tree.h"
#include "octree/builder/tree/chunk_vertices.h"
#include "octree/builder/tree/page_plan.h"
#include "octree/builder/tree/wide_tree.h"
#include "octree/nearest/nearest.h"
#include "octree/page/frame.h"
#include "octree/page/page_decoder.h"

/// Small models, the stages of their build, and their decoded pages.
namespace planetree::octree {

using Soup = std::vector<std::array<Vec3, 3>>;

/// Pseudo-random numbers, the same on every machine.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15 + 1) {}
  std::uint32_t bits() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::uint32_t>(state_ >> 33);
  }
  /// In [low, high), with 31 random bits.
  double uniform(double low, double high) { return low + (high - low) * (bits() * 0x1p-31); }
  Vec3 point(double low, double high) {
    const double x = uniform(low, high), y = uniform(low, high), z = uniform(low, high);
    return {x, y, z};
  }

 private:
  std::uint64_t state_;
};

/// An octahedron whose faces are divided into 4^`levels` each, projected to the unit sphere.
/// float32 coordinates, watertight.
Soup sphere(unsigned levels);
/// A wavy height field of 2 `side`^2 triangles, float32 coordinates.
Soup height_field(unsigned side);
/// Random triangles in the unit cube with edges up to `edge`, float64 coordinates.
Soup scattered(std::size_t count, double edge, std::uint64_t seed = 1);
/// `count` copies of one triangle, all with the same Morton code.
Soup repeated(std::size_t count);

/// The triangles of a model in the model frame, in the order of the input.
struct SampleMesh : Triangles {
  SampleMesh() = default;
  SampleMesh(Triangles triangles, ModelFrame of)
      : Triangles(std::move(triangles)), frame(std::move(of)) {}

  Point lower() const { return frame.lower(); }
  Point upper() const { return frame.upper(); }

  ModelFrame frame;
};

/// A model in the model frame. Its triangle indices start at `first_index`.
SampleMesh store(const Soup& soup, std::uint64_t first_index = 0);

/// The file that tests spill to.
storage::SpillFile& spill_file();

/// The triangles of a mesh in runs of `run_triangles`, some of them spilled.
std::unique_ptr<TriangleRuns> runs_of(const SampleMesh& mesh, std::uint32_t run_triangles = 1000);

/// The mask of a watertight mesh, built in sectors of at most `most` triangles.
///
/// tree  the tree whose blocks the cells list; null for a mask without lists.
MaskTree mask_of(const SampleMesh& mesh, std::uint64_t most = kSectorTriangles,
                 const BuiltTree* tree = nullptr);

/// The edge balance of a mesh, counted in parts of `part_triangles` triangles.
EdgeBalance balance_of(const SampleMesh& mesh, std::uint32_t part_triangles = 5000);

/// A model after all stages of a build but the writing of its file.
struct SampleTree {
  SampleMesh mesh;  ///< in Morton order
  Point centre = Point::Zero();
  BlockShape shape;
  std::vector<MortonKey> keys;
  std::vector<BinaryNode> binary;
  WideTree tree;
  ChunkVertices vertices{Triangles()};
  std::vector<std::uint8_t> block_slots;
  PagePlan plan;
};

SampleTree build_sample(const Soup& soup, std::uint32_t page_bytes = 4096,
                        std::uint64_t first_index = 0, bool moments = false);

PageInfo page_info(const SampleTree& sample, std::uint32_t page);
TreeInfo tree_info(const SampleTree& sample);

/// Memory for exactly one decoded page, aligned as frames are.
class SampleFrame {
 public:
  explicit SampleFrame(std::uint32_t page_bytes) : slots_(page_bytes / kSlotBytes) {}
  std::span<std::byte> bytes() {
    return {reinterpret_cast<std::byte*>(slots_.data()), slots_.size() * kSlotBytes};
  }
  const std::byte* data() const { return reinterpret_cast<const std::byte*>(slots_.data()); }
  const FrameHeader& header() const { return *reinterpret_cast<const FrameHeader*>(data()); }
  const Node& node(std::size_t index, const BlockShape& shape = {}) const {
    const std::size_t slot = header().first_node_slot + shape.node_slots() * index;
    return *reinterpret_cast<const Node*>(data() + slot * kSlotBytes);
  }

 private:
  struct alignas(kSlotBytes) Slot {
    std::byte bytes[kSlotBytes];
  };
  std::vector<Slot> slots_;
};

/// All pages of a sample, encoded and decoded again.
class SamplePages {
 public:
  explicit SamplePages(const SampleTree& sample);

  std::size_t size() const { return frames_.size(); }
  const std::vector<std::byte>& raw(std::uint32_t page) const { return raw_[page]; }
  const SampleFrame& frame(std::uint32_t page) const { return frames_[page]; }
  SampleFrame& frame(std::uint32_t page) { return frames_[page]; }
  /// The record that a link to a slot leads to.
  const std::byte* record(const LinkFormat& links, std::uint32_t link) const {
    return frames_[links.page(link)].data() + links.record(link) * kSlotBytes;
  }

  /// The node that a link of the page plan leads to.
  const std::byte* node_record(const SampleTree& sample, StoredLink node) const {
    const std::uint32_t page_bytes = sample.plan.page_bytes;
    return record(LinkFormat(page_bytes, sample.shape.links),
                  node_link(page_bytes, sample.shape, node));
  }

  void withhold(std::uint32_t page) { withheld_[page] = true; }
  PageReader reader();

 private:
  std::vector<std::vector<std::byte>> raw_;
  std::vector<SampleFrame> frames_;
  std::vector<bool> withheld_;
};

}  // namespace planetree::octree
