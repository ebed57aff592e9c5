#include "tests/octree/sample_tree.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "octree/build/disc_fit.h"
#include "octree/build/moment_sums.h"
#include "octree/build/page_encoder.h"
#include "tests/octree/divided_octahedron.h"

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

Soup sheet(unsigned side) {
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

MeshStore store(const Soup& soup, std::uint64_t first_index) {
  MeshStore mesh;
  for (std::size_t i = 0; i < soup.size(); ++i)
    if (!mesh.triangle(first_index + i, soup[i])) std::abort();
  mesh.normalise();
  return mesh;
}

SampleTree build_sample(const Soup& soup, std::uint32_t page_bytes, std::uint64_t first_index,
                        bool moments) {
  SampleTree sample;
  sample.mesh = store(soup, first_index);
  sample.centre = (sample.mesh.lower() + sample.mesh.upper()) * 0.5;
  sample.shape.float64 = sample.mesh.float64();
  sample.shape.wide_ids = first_index + soup.size() > 0xffffffff;
  sample.shape.moments = moments;
  sample.keys = morton_order(sample.mesh);
  sample.binary = build_binary_tree(sample.mesh, sample.centre, sample.keys);
  sample.tree = collapse(sample.binary);
  fit_discs(sample.mesh, sample.centre, sample.keys, sample.tree);
  if (moments)
    sample.tree.moments = sum_moments(sample.mesh, sample.centre, sample.keys, sample.tree);
  for (const WideBlock& block : sample.tree.blocks)
    sample.block_slots.push_back(static_cast<std::uint8_t>(
        sample.shape.slots(count_block_vertices(sample.mesh, sample.keys, block))));
  sample.plan = *plan_pages(sample.tree, sample.keys,
                            {sample.shape.node_slots(), sample.block_slots}, page_bytes);
  return sample;
}

PageFacts page_facts(const SampleTree& sample, std::uint32_t page) {
  PageFacts facts;
  facts.page_bytes = sample.plan.page_bytes;
  facts.page_count = static_cast<std::uint32_t>(sample.plan.pages.size());
  facts.shape = sample.shape;
  facts.page_number = page;
  facts.octcode = sample.plan.pages[page].octcode;
  facts.ordinal = sample.plan.pages[page].ordinal;
  return facts;
}

TreeFacts tree_facts(const SampleTree& sample) {
  TreeFacts facts;
  facts.page_bytes = sample.plan.page_bytes;
  facts.root_link =
      sample.tree.nodes.empty() ? sample.plan.block_links[0] : sample.plan.node_links[0];
  facts.shape = sample.shape;
  facts.record_count = sample.tree.nodes.size() + sample.tree.blocks.size();
  facts.box_lower = sample.mesh.lower();
  facts.box_upper = sample.mesh.upper();
  facts.centre = sample.centre;
  facts.sample = sample.mesh.corners(0)[0];
  facts.sample_triangle = sample.mesh.index(0);
  return facts;
}

SamplePages::SamplePages(const SampleTree& sample) : withheld_(sample.plan.pages.size()) {
  const PageEncoder encoder(sample.mesh, sample.keys, sample.tree, sample.plan, sample.shape);
  for (std::uint32_t page = 0; page < sample.plan.pages.size(); ++page) {
    raw_.push_back(encoder.encode(page));
    frames_.emplace_back(sample.plan.page_bytes);
    const auto decoded = decode_page(raw_[page], page_facts(sample, page), frames_[page].bytes());
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
