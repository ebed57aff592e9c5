#include "tests/query/sample_model.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "octree/builder/cap_tree.h"
#include "octree/builder/mask/mask_encoder.h"
#include "octree/builder/surface/edge_balance.h"
#include "planetree/build.h"
#include "storage/file/page_writer.h"

namespace planetree::query {
namespace {

[[noreturn]] void give_up(const Error& error) {
  std::fprintf(stderr, "sample: %s\n", error.text);
  std::abort();
}

storage::ModelRecord describe(const octree::SampleTree& sample) {
  const octree::TreeInfo info = octree::tree_info(sample);
  storage::ModelRecord model{};
  model.triangle_count = sample.mesh.size();
  model.first_skipped = storage::kNoTriangle;
  model.vertex_count = std::uint64_t{3} * sample.mesh.size();
  model.node_count = sample.tree.nodes.size();
  model.block_count = sample.tree.blocks.size();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    model.box_lower[axis] = sample.mesh.frame.input_lower[axis];
    model.box_upper[axis] = sample.mesh.frame.input_upper[axis];
    model.core_lower[axis] = sample.mesh.frame.input_core_lower[axis];
    model.core_upper[axis] = sample.mesh.frame.input_core_upper[axis];
    model.centre[axis] = info.centre[axis];
    model.sample[axis] = info.sample[axis];
  }
  model.stray_count = sample.mesh.frame.stray_count;
  model.stray_edge = sample.mesh.frame.stray_edge;
  model.sample_triangle = info.sample_triangle;
  // Indices before the first triangle are those of skipped records.
  model.skipped_count = info.sample_triangle;
  if (model.skipped_count > 0) model.first_skipped = 0;
  model.scale_exponent = sample.mesh.frame.scale_exponent;
  model.vertex_kind =
      sample.shape.float64 ? storage::VertexKind::kFloat64 : storage::VertexKind::kFloat32;
  model.triangle_id_bytes = sample.shape.wide_ids ? 8 : 4;
  model.height = sample.tree.nodes.empty() ? 0 : sample.tree.nodes[0].height;
  octree::balance_of(sample.mesh).describe(sample.mesh.frame.scale_exponent, model);
  return model;
}

void append(storage::PageWriter& writer, std::uint64_t octcode, const std::vector<std::byte>& raw) {
  const auto appended =
      writer.append(octcode, static_cast<std::uint32_t>(raw.size()), storage::compress_page(raw));
  if (!appended) give_up(appended.error());
}

void need(const Result<void>& result) {
  if (!result) give_up(result.error());
}

// Makes the tree of the caps that close a sample.
void close(const octree::SampleTree& sample, std::uint32_t first_page, octree::CapTree& caps) {
  constexpr std::uint64_t kHeldBytes = 1 << 20;
  octree::CapChain boundary(kHeldBytes, octree::spill_file());
  octree::EdgeCensus census(kHeldBytes, octree::spill_file());
  need(census.add(sample.mesh));
  if (!census.balance(&boundary)) std::abort();
  octree::RegionCut cut(sample.mesh.frame, {}, nullptr);
  need(caps.close(boundary, cut));
  octree::MaskSectors sectors(sample.mesh.frame.core_lower(), {}, 0, sample.shape.float64,
                              kHeldBytes, octree::spill_file());
  need(caps.build(sectors, octree::kChunkTriangles));
  need(caps.number_pages(first_page));
}

// Appends the pages of the caps, and describes these.
void append_caps(const octree::CapTree& caps, storage::PageWriter& writer,
                 storage::ModelRecord& model) {
  caps.describe(model);
  if (!caps.tree()) return;
  const octree::TreePages& pages = caps.tree()->pages();
  writer.begin_caps();
  for (std::uint32_t page = 0; page < pages.size(); ++page) {
    const auto encoded = pages.encode(pages.first() + page);
    if (!encoded) give_up(encoded.error());
    append(writer, encoded->octcode, encoded->bytes);
  }
}

void write(const octree::SampleTree& sample, bool masked, const std::filesystem::path& path) {
  const octree::SamplePages pages(sample);
  const auto tree_pages = static_cast<std::uint32_t>(pages.size());
  octree::CapTree caps(sample.mesh.frame, sample.shape, sample.plan.page_bytes, 1 << 20,
                       octree::spill_file(), octree::spill_file());
  close(sample, tree_pages, caps);
  const std::uint32_t page_count = tree_pages + (caps.tree() ? caps.tree()->pages().size() : 0);
  octree::MaskTree mask;
  octree::MaskPlan mask_plan;
  if (masked) {
    mask = octree::mask_of(sample.mesh);
    mask_plan = octree::plan_mask(mask, sample.plan.page_bytes);
  }
  const auto mask_pages = static_cast<std::uint32_t>(mask_plan.pages.size());
  auto writer = storage::PageWriter::create(path, page_count + mask_pages, {}, false);
  if (!writer) give_up(writer.error());
  for (std::uint32_t page = 0; page < tree_pages; ++page)
    append(*writer, sample.plan.pages[page].octcode, pages.raw(page));
  storage::ModelRecord model = describe(sample);
  append_caps(caps, *writer, model);
  if (masked) {
    writer->begin_mask();
    const octree::MaskEncoder encoder(mask, mask_plan, page_count, sample.shape.float64);
    for (std::uint32_t page = 0; page < mask_pages; ++page)
      append(*writer, mask_plan.pages[page].octcode, encoder.encode(page).bytes);
    model.mask_cell_count = mask.entries.size();
    model.mask_page_count = mask_pages;
    model.mask_levels = static_cast<std::uint8_t>(mask.levels);
  }
  const auto header = writer->finish(model, sample.plan.page_bytes);
  if (!header) give_up(header.error());
}

}  // namespace

SampleModel::SampleModel(const Soup& soup, std::uint32_t page_bytes, std::uint64_t first_index)
    : SampleModel(soup, page_bytes, first_index, false) {}

SampleModel::SampleModel(const Soup& soup, std::uint32_t page_bytes, std::uint64_t first_index,
                         bool masked)
    : sample_(octree::build_sample(soup, page_bytes, first_index)) {
  write(sample_, masked, path());
}

SampleModel SampleModel::masked(const Soup& soup, std::uint32_t page_bytes) {
  return {soup, page_bytes, 0, true};
}

std::uint64_t SampleModel::min_budget(unsigned max_probes) const {
  OpenOptions options;
  options.memory_budget_bytes = 0;
  options.max_probes = max_probes;
  const auto model = Model::open(path(), options);
  if (model) return 0;
  const std::string text = model.error().text;
  const std::string before = "at least ";
  const std::size_t at = text.find(before);
  if (at == std::string::npos) give_up(model.error());
  return std::strtoull(text.c_str() + at + before.size(), nullptr, 10);
}

Model SampleModel::open(std::uint64_t budget_bytes, unsigned max_probes) const {
  OpenOptions options;
  options.memory_budget_bytes = budget_bytes;
  options.max_probes = max_probes;
  return open(options);
}

Model SampleModel::open(const OpenOptions& options) const {
  auto model = Model::open(path(), options);
  if (!model) give_up(model.error());
  return *std::move(model);
}

Model SampleModel::open_for_batches(unsigned batch_threads, unsigned max_probes) const {
  OpenOptions options;
  options.batch_threads = batch_threads;
  options.max_probes = max_probes;
  return open(options);
}

SampleModel::Truth SampleModel::truth(const Vec3& query) const {
  const double scale = std::ldexp(1.0, sample_.mesh.frame.scale_exponent);
  const octree::Point point(query.x * scale, query.y * scale, query.z * scale);
  double least = std::numeric_limits<double>::infinity();
  std::uint32_t nearest = 0;
  for (std::uint32_t i = 0; i < sample_.mesh.size(); ++i) {
    const double squared = octree::triangle_value(point, sample_.mesh.corners(i)).squared;
    const bool first = sample_.mesh.index(i) < sample_.mesh.index(nearest);
    if (squared > least || (squared == least && !first)) continue;
    least = squared;
    nearest = i;
  }
  const double error =
      octree::nearest_on_triangle(point, sample_.mesh.corners(nearest)).value.error;
  return {std::sqrt(least) / scale, error / scale, sample_.mesh.index(nearest)};
}

double SampleModel::distance(const Vec3& query) const { return truth(query).distance; }

std::uint64_t SampleModel::nearest_triangle(const Vec3& query) const {
  return truth(query).triangle;
}

bool SampleModel::interval_holds(const ClosestPoint& answer, const Vec3& query) const {
  const Truth known = truth(query);
  return answer.lower < answer.upper && answer.lower <= known.distance + known.error &&
         answer.upper >= known.distance - known.error;
}

void build_soup(const Soup& soup, const std::filesystem::path& path, BuildOptions options,
                std::uint32_t page_bytes) {
  std::vector<Vec3> vertices;
  std::vector<TriangleVertices> triangles;
  for (const auto& corners : soup) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), corners.begin(), corners.end());
    triangles.push_back({first, first + 1, first + 2});
  }
  options.page_bytes = page_bytes;
  const auto report = build(BuildInput(vertices, triangles), path, options);
  if (!report) give_up(report.error());
}

Probe make_probe(const Model& model) {
  auto probe = Probe::create(model);
  if (!probe) give_up(probe.error());
  return *std::move(probe);
}

std::vector<Vec3> random_queries(std::size_t count, double low, double high, std::uint64_t seed) {
  octree::Noise noise(seed);
  std::vector<Vec3> queries;
  for (std::size_t i = 0; i < count; ++i) queries.push_back(noise.point(low, high));
  return queries;
}

}  // namespace planetree::query
