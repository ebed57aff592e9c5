#include "octree/build/tree_builder.h"

#include <bit>
#include <limits>
#include <optional>
#include <vector>

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "octree/build/binary_tree.h"
#include "octree/build/disc_fit.h"
#include "octree/build/edge_balance.h"
#include "octree/build/mask_encoder.h"
#include "octree/build/mask_plan.h"
#include "octree/build/mask_tree.h"
#include "octree/build/mesh_reader.h"
#include "octree/build/mesh_store.h"
#include "octree/build/moment_sums.h"
#include "octree/build/morton_order.h"
#include "octree/build/page_encoder.h"
#include "octree/build/page_plan.h"
#include "octree/build/wide_tree.h"
#include "octree/frame.h"
#include "octree/strict_math.h"
#include "storage/page_codec.h"
#include "storage/page_writer.h"

namespace planetree::octree {
namespace {

// Pages encoded together before they are written in order.
constexpr std::uint32_t kBatchPages = 256;

class TreeBuild {
 public:
  TreeBuild(const std::filesystem::path& input, const std::filesystem::path& output,
            const BuildOptions& options, BuildProgress& progress)
      : input_(input), output_(output), options_(options), progress_(progress) {}

  Result<BuildReport> run() {
    if (const auto read = read_model(); !read) return read.error();
    balance();
    order_triangles();
    if (const auto bounded = bound_nodes(); !bounded) return bounded.error();
    if (const auto coloured = colour_cells(); !coloured) return coloured.error();
    return write_pages();
  }

 private:
  Result<void> read_model();
  void balance();
  void order_triangles();
  Result<void> bound_nodes();
  Result<void> colour_cells();
  Result<BuildReport> write_pages();
  template <class Encoder, class Pages>
  Result<void> append_pages(storage::PageWriter& writer, const Encoder& encoder, const Pages& pages,
                            std::uint32_t written);
  std::uint32_t distance_pages() const { return static_cast<std::uint32_t>(plan_.pages.size()); }
  std::uint32_t mask_pages() const { return static_cast<std::uint32_t>(mask_plan_.pages.size()); }
  storage::ModelRecord describe() const;

  const std::filesystem::path& input_;
  const std::filesystem::path& output_;
  const BuildOptions& options_;
  BuildProgress& progress_;
  MeshStore mesh_;
  std::uint64_t vertex_records_ = 0;
  Point centre_ = Point::Zero();
  BlockShape shape_;
  EdgeBalance edges_;
  std::vector<MortonKey> keys_;
  WideTree tree_;
  PagePlan plan_;
  MaskTree mask_;
  MaskPlan mask_plan_;
};

Result<void> TreeBuild::read_model() {
  const auto report = [](void* context, std::uint64_t done, std::uint64_t total) {
    static_cast<BuildProgress*>(context)->progress(BuildPhase::kReading, done, total);
  };
  mesh_.report_progress(report, &progress_);
  const Result<MeshSummary> summary = read_mesh(input_, mesh_);
  if (!summary) return summary.error();
  if (options_.strict && mesh_.set_aside_count() > 0)
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "%s; repair the mesh or build without --strict",
                      mesh_.first_set_aside_text().c_str());
  vertex_records_ = summary->vertex_records;
  mesh_.normalise();
  centre_ = (mesh_.lower() + mesh_.upper()) * 0.5;
  shape_.float64 = mesh_.float64();
  shape_.wide_ids = summary->triangle_indices > std::numeric_limits<std::uint32_t>::max();
  return {};
}

void TreeBuild::balance() {
  progress_.progress(BuildPhase::kClosing, 0, 1);
  edges_ = balance_edges(mesh_);
  shape_.moments = edges_.open_edges > 0;
  progress_.progress(BuildPhase::kClosing, 1, 1);
}

void TreeBuild::order_triangles() {
  progress_.progress(BuildPhase::kOrdering, 0, 3);
  keys_ = morton_order(mesh_);
  progress_.progress(BuildPhase::kOrdering, 1, 3);
  const std::vector<BinaryNode> binary = build_binary_tree(mesh_, centre_, keys_);
  progress_.progress(BuildPhase::kOrdering, 2, 3);
  tree_ = collapse(binary);
  progress_.progress(BuildPhase::kOrdering, 3, 3);
}

Result<void> TreeBuild::bound_nodes() {
  progress_.progress(BuildPhase::kBounding, 0, 2);
  fit_discs(mesh_, centre_, keys_, tree_);
  if (shape_.moments) tree_.moments = sum_moments(mesh_, centre_, keys_, tree_);
  progress_.progress(BuildPhase::kBounding, 1, 2);
  std::vector<std::uint8_t> block_slots(tree_.blocks.size());
  tbb::parallel_for(std::size_t{0}, tree_.blocks.size(), [&](std::size_t i) {
    const unsigned vertices = count_block_vertices(mesh_, keys_, tree_.blocks[i]);
    block_slots[i] = static_cast<std::uint8_t>(shape_.slots(vertices));
  });
  auto plan = plan_pages(tree_, keys_, {shape_.node_slots(), block_slots}, options_.page_bytes);
  if (!plan) return plan.error();
  plan_ = std::move(*plan);
  progress_.progress(BuildPhase::kBounding, 2, 2);
  return {};
}

// Only where winding numbers are constant off the surface.
Result<void> TreeBuild::colour_cells() {
  if (edges_.open_edges > 0) return {};
  progress_.progress(BuildPhase::kColouring, 0, 1);
  mask_ = build_mask(mesh_, keys_);
  auto plan = plan_mask(mask_, options_.page_bytes);
  if (!plan) return plan.error();
  mask_plan_ = std::move(*plan);
  progress_.progress(BuildPhase::kColouring, 1, 1);
  return {};
}

Result<BuildReport> TreeBuild::write_pages() {
  auto writer =
      storage::PageWriter::create(output_, distance_pages() + mask_pages(), options_.replace);
  if (!writer) return writer.error();
  const PageEncoder encoder(mesh_, keys_, tree_, plan_, shape_);
  if (const auto appended = append_pages(*writer, encoder, plan_.pages, 0); !appended)
    return appended.error();
  writer->begin_mask();
  const MaskEncoder masks(mask_, mask_plan_, distance_pages(), shape_.float64);
  const auto appended = append_pages(*writer, masks, mask_plan_.pages, distance_pages());
  if (!appended) return appended.error();
  const auto header = writer->finish(describe(), options_.page_bytes);
  if (!header) return header.error();
  return BuildReport{*header, mesh_.first_set_aside_text()};
}

template <class Encoder, class Pages>
Result<void> TreeBuild::append_pages(storage::PageWriter& writer, const Encoder& encoder,
                                     const Pages& pages, std::uint32_t written) {
  struct Encoded {
    std::uint32_t raw_bytes = 0;
    std::optional<storage::StoredPage> stored;
  };
  const auto page_count = static_cast<std::uint32_t>(pages.size());
  const std::uint32_t all_pages = distance_pages() + mask_pages();
  std::vector<Encoded> batch(kBatchPages);
  for (std::uint32_t first = 0; first < page_count; first += kBatchPages) {
    progress_.progress(BuildPhase::kWriting, written + first, all_pages);
    const std::uint32_t count = std::min(kBatchPages, page_count - first);
    tbb::parallel_for(std::uint32_t{0}, count, [&](std::uint32_t i) {
      const std::vector<std::byte> raw = encoder.encode(first + i);
      batch[i] = {static_cast<std::uint32_t>(raw.size()), storage::encode_page(raw)};
    });
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto& page = pages[first + i];
      const auto appended =
          writer.append(page.octcode, page.ordinal, batch[i].raw_bytes, *batch[i].stored);
      if (!appended) return appended;
    }
  }
  progress_.progress(BuildPhase::kWriting, written + page_count, all_pages);
  return {};
}

storage::ModelRecord TreeBuild::describe() const {
  storage::ModelRecord model{};
  model.triangle_count = mesh_.size();
  model.set_aside_count = mesh_.set_aside_count();
  model.first_set_aside = mesh_.first_set_aside();
  model.vertex_count = vertex_records_;
  model.node_count = tree_.nodes.size();
  model.block_count = tree_.blocks.size();
  const Point sample = mesh_.corners(0)[0];
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    model.box_lower[axis] = mesh_.input_lower()[axis];
    model.box_upper[axis] = mesh_.input_upper()[axis];
    model.centre[axis] = centre_[axis];
    model.sample[axis] = sample[axis];
  }
  model.sample_triangle = mesh_.index(0);
  model.scale_exponent = mesh_.scale_exponent();
  model.root_link = tree_.nodes.empty() ? plan_.block_links[0] : plan_.node_links[0];
  model.vertex_kind =
      shape_.float64 ? storage::VertexKind::kFloat64 : storage::VertexKind::kFloat32;
  model.triangle_id_bytes = shape_.wide_ids ? 8 : 4;
  model.height = tree_.nodes.empty() ? 0 : tree_.nodes[0].height;
  edges_.describe(mesh_.scale_exponent(), model);
  model.mask_cell_count = mask_.entries.size();
  model.mask_page_count = mask_pages();
  model.mask_levels = static_cast<std::uint8_t>(mask_.levels);
  return model;
}

}  // namespace

Result<BuildReport> build_tree(const std::filesystem::path& input,
                               const std::filesystem::path& output, const BuildOptions& options,
                               BuildProgress& progress) {
  if (!std::has_single_bit(options.page_bytes) || options.page_bytes < storage::kMinPageBytes ||
      options.page_bytes > storage::kMaxPageBytes)
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "a page of %u bytes; use a power of two from 4K to 256K", options.page_bytes);
  const int threads =
      options.threads > 0 ? static_cast<int>(options.threads) : tbb::task_arena::automatic;
  std::optional<tbb::global_control> limit;
  if (options.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, options.threads);
  tbb::task_arena arena(threads);
  return arena.execute([&] { return TreeBuild(input, output, options, progress).run(); });
}

}  // namespace planetree::octree
