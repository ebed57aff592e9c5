#include "tests/octree/support/sample_tree.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <mutex>

#include "octree/builder/sort/triangle_spool.h"
#include "octree/builder/surface/region_cut.h"
#include "octree/builder/tree/block_slots.h"
#include "octree/builder/tree/disc_fit.h"
#include "octree/builder/tree/moment_sums.h"
#include "octree/builder/tree/page_encoder.h"
#include "tests/octree/support/divided_octahedron.h"

namespace planetree::octree {
namespace {

// Volatile, because g++ 12 at -O2 drops the rounding where it vectorises a pair
// of conversions from double to float and back.
double rounded(double value) {
  const volatile float result = static_cast<float>(value);
  return result;
}

Vec3 to_float(const Vec3& p) { return {rounded(p.x), rounded(p.y), rounded(p.z)}; }

Vec3 on_sphere(const Vec3& a, const Vec3& b) {
  const Vec3 sum{a.x + b.x, a.y + b.y, a.z + b.z};
  const double length = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
  return to_float({sum.x / length, sum.y / length, sum.z / length});
}

}  // namespace

Soup sphere(unsigned levels) { return DividedOctahedron(levels, on_sphere).faces(); }

Soup height_field(unsigned side) {
  const auto at = [side](unsigned i, unsigned j) {
    const double x = static_cast<double>(i) / side, y = static_cast<double>(j) / side;
    return to_float({x, y, 0.25 * x * (1 - x) * (1 - 2 * y)});
  };
  Soup soup;
  for (unsigned i = 0; i < side; ++i)
    for (unsigned j = 0; j < side; ++j) {
      soup.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      soup.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return soup;
}

Soup scattered(std::size_t count, double edge, std::uint64_t seed) {
  Noise noise(seed);
  Soup soup;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 at = noise.point(0, 1);
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) {
      const Vec3 from = noise.point(0, edge);
      corner = {at.x + from.x / 3, at.y + from.y / 3, at.z + from.z / 3};
    }
    soup.push_back(corners);
  }
  return soup;
}

Soup repeated(std::size_t count) {
  return Soup(count, {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0.5}});
}

SampleMesh store(const Soup& soup, std::uint64_t first_index) {
  TriangleSpool spool(std::numeric_limits<std::uint32_t>::max(), ~std::uint64_t{0}, spill_file());
  for (std::size_t i = 0; i < soup.size(); ++i)
    if (!spool.triangle(first_index + i, soup[i])) std::abort();
  ModelFrame frame = *spool.finish();
  return {*spool.take_batch(0), std::move(frame)};
}

storage::SpillFile& spill_file() {
  static storage::SpillFile file(std::filesystem::temp_directory_path(), 100000);
  return file;
}

std::unique_ptr<TriangleRuns> runs_of(const SampleMesh& mesh, std::uint32_t run_triangles) {
  const std::size_t run_bytes = run_triangles * mesh.record_bytes();
  auto runs = std::make_unique<TriangleRuns>(mesh.float64(), 3 * run_bytes, spill_file());
  for (std::uint32_t first = 0; first < mesh.size(); first += run_triangles) {
    const std::uint32_t last = std::min(mesh.size(), first + run_triangles);
    Triangles run(mesh.float64());
    for (std::uint32_t i = first; i < last; ++i) run.add(mesh.key(i), mesh.corners(i));
    if (!runs->add(std::move(run))) std::abort();
  }
  return runs;
}

// Replaces the entry at `index` by the root of `part` and appends the other entries of `part`.
void put_in(MaskTree& whole, std::size_t index, MaskTree part) {
  const auto first_new = static_cast<std::uint32_t>(whole.entries.size() - 1);
  const auto specials = static_cast<std::uint32_t>(whole.specials.size());
  const auto lists = static_cast<std::uint32_t>(whole.lists.size());
  for (MaskEntry& entry : part.entries) {
    if (entry.kind == MaskEntry::Kind::kNode) entry.first += first_new;
    if (entry.kind == MaskEntry::Kind::kSpecial) entry.first += specials;
    if (entry.kind == MaskEntry::Kind::kListed) entry.first += lists;
  }
  whole.entries[index] = part.entries.front();
  whole.entries.insert(whole.entries.end(), part.entries.begin() + 1, part.entries.end());
  whole.specials.insert(whole.specials.end(), part.specials.begin(), part.specials.end());
  whole.lists.insert(whole.lists.end(), part.lists.begin(), part.lists.end());
}

MaskTree mask_of(const SampleMesh& mesh, std::uint64_t most, const BuiltTree* tree) {
  const auto runs = runs_of(mesh);
  RegionCut cut(mesh.frame, {}, nullptr);
  if (!cut.add(mesh)) std::abort();
  MaskSectors sectors(mesh.frame.core_lower(), {}, cut.found().winding, mesh.float64(), 1000,
                      spill_file());
  if (!sectors.divide(*runs, nullptr, mesh.frame.stray_count > 0, most) || !sectors.add(mesh))
    std::abort();
  std::mutex mutex;
  std::map<std::size_t, MaskTree> parts;
  MaskTree whole = *build_mask(
      sectors, *runs, tree, [](std::size_t) { return nullptr; },
      [&](std::size_t at, const MaskTree& part, const SectorRoot&) -> Result<void> {
        const std::lock_guard lock(mutex);
        parts[at] = part;
        return {};
      });
  for (std::size_t i = 0; i < whole.entries.size(); ++i)
    if (whole.entries[i].kind == MaskEntry::Kind::kSector)
      put_in(whole, i, parts.at(whole.entries[i].first));
  for (const auto& [at, part] : parts) whole.levels = std::max(whole.levels, part.levels);
  return whole;
}

EdgeBalance balance_of(const SampleMesh& mesh, std::uint32_t part_triangles) {
  EdgeCensus census(1000, spill_file());
  const auto add_parts = [&](const auto& add) {
    for (std::uint32_t first = 0; first < mesh.size(); first += part_triangles) {
      Triangles part(mesh.float64());
      for (std::uint32_t i = first; i < std::min(mesh.size(), first + part_triangles); ++i)
        part.add(mesh.key(i), mesh.corners(i));
      add(part);
    }
  };
  add_parts([&](const Triangles& part) {
    if (!census.add(part)) std::abort();
  });
  CapChain boundary(1000, spill_file());
  EdgeFaces faces(*census.balance(&boundary));
  add_parts([&](const Triangles& part) { faces.look_at(part); });
  return faces.balance();
}

SampleTree build_sample(const Soup& soup, std::uint32_t page_bytes, std::uint64_t first_index,
                        bool moments) {
  SampleTree sample;
  sample.mesh = store(soup, first_index);
  sample.mesh.sort();
  sample.centre = sample.mesh.frame.centre();
  sample.shape.float64 = sample.mesh.float64();
  sample.shape.wide_ids = first_index + soup.size() > 0xffffffff;
  sample.shape.moments = moments;
  sample.keys = keys_of(sample.mesh);
  sample.binary = build_binary_tree(sample.mesh, sample.centre, sample.keys);
  sample.tree = collapse(sample.binary);
  sample.vertices = ChunkVertices(sample.mesh);
  sample.vertices.list_blocks(sample.tree.blocks, sample.keys);
  sample.block_slots =
      block_slots(sample.mesh, sample.vertices, sample.keys, sample.tree.blocks, sample.shape);
  const RecordSlots slots{sample.shape.node_slots(), sample.block_slots};
  part_blocks(sample.tree, slots, page_bytes);
  fit_discs(sample.mesh, sample.vertices, sample.centre, sample.keys, sample.tree);
  if (moments)
    sample.tree.moments =
        sum_moments(sample.mesh, sample.centre, sample.keys, sample.tree, sample.binary[0].box)
            .nodes;
  sample.plan = *plan_pages(sample.tree, sample.keys, slots, page_bytes);
  return sample;
}

PageInfo page_info(const SampleTree& sample, std::uint32_t page) {
  PageInfo info;
  info.page_bytes = sample.plan.page_bytes;
  info.page_count = static_cast<std::uint32_t>(sample.plan.pages.size());
  info.shape = sample.shape;
  info.page_number = page;
  info.octcode = sample.plan.pages[page].octcode;
  return info;
}

TreeInfo tree_info(const SampleTree& sample) {
  TreeInfo info;
  info.page_bytes = sample.plan.page_bytes;
  info.root_link = root_link_of(info.page_bytes, sample.shape.links, 0, sample.tree.nodes.size());
  info.shape = sample.shape;
  info.record_count = sample.tree.nodes.size() + sample.tree.blocks.size();
  info.box_lower = sample.mesh.frame.lower();
  info.box_upper = sample.mesh.frame.upper();
  info.core_lower = sample.mesh.frame.core_lower();
  info.core_upper = sample.mesh.frame.core_upper();
  info.set_strays(sample.mesh.frame.stray_count, sample.mesh.frame.stray_edge);
  info.centre = sample.centre;
  info.sample = sample.mesh.frame.scaled(sample.mesh.frame.input_sample);
  info.sample_triangle = sample.mesh.frame.sample_triangle;
  return info;
}

SamplePages::SamplePages(const SampleTree& sample) : withheld_(sample.plan.pages.size()) {
  const PageEncoder encoder(sample.mesh, sample.vertices, sample.keys, sample.tree, sample.plan,
                            sample.shape);
  for (std::uint32_t page = 0; page < sample.plan.pages.size(); ++page) {
    raw_.push_back(encoder.encode(page).bytes);
    frames_.emplace_back(sample.plan.page_bytes);
    const auto decoded = decode_page(raw_[page], page_info(sample, page), frames_[page].bytes());
    if (decoded) continue;
    std::fprintf(stderr, "sample: %s\n", decoded.error().text);
    std::abort();
  }
}

PageReader SamplePages::reader() {
  return {this, [](void* context, std::uint32_t page) noexcept -> const std::byte* {
            const auto& pages = *static_cast<SamplePages*>(context);
            if (page >= pages.frames_.size() || pages.withheld_[page]) return nullptr;
            return pages.frames_[page].data();
          }};
}

}  // namespace planetree::octree
