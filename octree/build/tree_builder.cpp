#include "octree/build/tree_builder.h"

#include <bit>
#include <limits>
#include <optional>
#include <vector>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "octree/build/build_memory.h"
#include "octree/build/built_mask.h"
#include "octree/build/crown.h"
#include "octree/build/edge_balance.h"
#include "octree/build/mesh_intake.h"
#include "octree/build/mesh_reader.h"
#include "octree/build/page_appender.h"
#include "octree/build/page_numbers.h"
#include "octree/build/parallel.h"
#include "octree/build/patch_build.h"
#include "octree/build/patches.h"
#include "octree/build/phase_count.h"
#include "octree/build/space_need.h"
#include "octree/build/tree_pages.h"
#include "octree/build/triangle_runs.h"
#include "octree/strict_math.h"
#include "storage/page_writer.h"

namespace planetree::octree {
namespace {

std::filesystem::path directory_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : ".";
}

class TreeBuild {
 public:
  TreeBuild(const std::filesystem::path& input, const std::filesystem::path& output,
            const BuildOptions& options, const BuildMemory& memory, BuildProgress& progress,
            const BuildSeams& seams)
      : input_(input),
        output_(output),
        options_(options),
        memory_(memory),
        progress_(progress),
        seams_(seams),
        file_(options.spill_directory(output), 0, seams.calls),
        pages_file_(options.spill_directory(output), memory.pages_bytes, seams.calls) {}

  Result<BuildReport> run() {
    if (const auto roomy = foresee_space(); !roomy) return roomy.error();
    if (const auto ordered = order_triangles(); !ordered) return ordered.error();
    if (const auto balanced = balance_edges(); !balanced) return balanced.error();
    if (const auto built = build_patches(); !built) return built.error();
    if (const auto coloured = colour_cells(); !coloured) return coloured.error();
    runs_.reset();
    return write_pages();
  }

  /// Where an error of run() is from.
  BuildPlace failed_at() const {
    if (file_.failed() || pages_file_.failed()) return BuildPlace::kTemporary;
    return place_;
  }

 private:
  Result<void> foresee_space();
  Result<void> check_space(const SpaceNeed& need);
  Result<void> order_triangles();
  Result<ModelFrame> read_model(MeshIntake& intake);
  Result<void> balance_edges();
  Result<void> build_patches();
  Result<void> colour_cells();
  Result<BuildReport> write_pages();
  template <class Work>
  Result<void> for_each_patch(BuildPhase phase, const Work& work);
  std::uint32_t mask_pages() const { return mask_ ? mask_->size() : 0; }
  storage::ModelRecord describe(std::uint32_t root_link) const;

  const std::filesystem::path& input_;
  const std::filesystem::path& output_;
  const BuildOptions& options_;
  const BuildMemory memory_;
  BuildProgress& progress_;
  const BuildSeams& seams_;
  BuildPlace place_ = BuildPlace::kInput;
  storage::SpillFile file_;
  storage::SpillFile pages_file_;
  MeshSize size_;
  ModelFrame frame_;
  std::uint64_t vertex_records_ = 0;
  BlockShape shape_;
  std::optional<TriangleRuns> runs_;
  PatchTree above_;
  EdgeBalance edges_;
  std::vector<BuiltPatch> patches_;
  std::optional<MaskRegions> regions_;  // of a watertight model
  std::optional<BuiltMask> mask_;
};

// Whether there is room, before a day of work rather than after.
Result<void> TreeBuild::foresee_space() {
  const auto size = MeshSize::foresee(input_);
  if (!size) return size.error();
  size_ = *size;
  return check_space(SpaceNeed::before_reading(size_, memory_));
}

Result<void> TreeBuild::check_space(const SpaceNeed& need) {
  BuildPlace short_of_room = place_;
  const auto checked = need.check(options_.spill_directory(output_), directory_of(output_),
                                  seams_.calls, short_of_room);
  if (!checked) place_ = short_of_room;
  return checked;
}

Result<ModelFrame> TreeBuild::read_model(MeshIntake& intake) {
  const auto report = [](void* context, std::uint64_t done, std::uint64_t total) {
    static_cast<BuildProgress*>(context)->progress(BuildPhase::kReading, done, total);
  };
  intake.report_progress(report, &progress_);
  const Result<MeshSummary> summary = read_mesh(input_, intake, {memory_.mapped_bytes});
  if (!summary) return summary.error();
  vertex_records_ = summary->vertex_records;
  shape_.wide_ids = summary->triangle_indices > std::numeric_limits<std::uint32_t>::max();
  auto frame = intake.finish();
  if (frame && options_.strict && frame->set_aside_count > 0)
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "%s; repair the mesh or build without --strict",
                      frame->first_set_aside_text.c_str());
  return frame;
}

Result<void> TreeBuild::order_triangles() {
  MeshIntake intake(memory_.chunk_triangles, memory_.intake_bytes, file_);
  auto frame = read_model(intake);
  if (!frame) return frame.error();
  frame_ = *std::move(frame);
  shape_.float64 = frame_.float64;
  // Now that they are counted.
  size_ = {frame_.triangle_count, size_.vertices, frame_.float64};
  if (const auto roomy = check_space(SpaceNeed::after_reading(size_, memory_)); !roomy)
    return roomy;
  runs_.emplace(frame_.float64, memory_.runs_bytes, file_);
  PhaseCount count(progress_, BuildPhase::kOrdering, intake.chunk_count());
  if (const auto taken = runs_->take(intake, [&count] { count.add(); }); !taken) return taken;
  auto above = cut_patches(*runs_, seams_.patch_triangles);
  if (!above) return above.error();
  above_ = *std::move(above);
  return {};
}

// Calls work(number, triangles in any order) for each.
template <class Work>
Result<void> TreeBuild::for_each_patch(BuildPhase phase, const Work& work) {
  PhaseCount count(progress_, phase, above_.patches.size());
  return for_each_in_parallel(above_.patches.size(), [&](std::size_t i) -> Result<void> {
    const Patch& patch = above_.patches[i];
    auto triangles = runs_->read_any_order(patch.from, patch.to);
    if (!triangles) return triangles.error();
    if (const Result<void> done = work(i, *triangles); !done) return done;
    count.add();
    return {};
  });
}

Result<void> TreeBuild::balance_edges() {
  EdgeCensus census(memory_.left_over_bytes, file_);
  const auto added = for_each_patch(
      BuildPhase::kClosing, [&](std::size_t, const Triangles& patch) { return census.add(patch); });
  if (!added) return added;
  auto balance = census.balance();
  if (!balance) return balance.error();
  edges_ = *balance;
  shape_.moments = edges_.open_edges > 0;
  if (!shape_.moments) return {};
  EdgeFaces faces(edges_);
  const auto looked = for_each_patch(BuildPhase::kListing,
                                     [&](std::size_t, const Triangles& patch) -> Result<void> {
                                       faces.look_at(patch);
                                       return {};
                                     });
  if (!looked) return looked;
  edges_ = faces.balance();
  return {};
}

Result<void> TreeBuild::build_patches() {
  if (edges_.open_edges == 0) {
    regions_.emplace(frame_.lower(), frame_.float64, memory_.left_over_bytes, file_);
    if (const auto divided = regions_->divide(*runs_, seams_.region_triangles); !divided)
      return divided;
  }
  patches_.resize(above_.patches.size());
  return for_each_patch(
      BuildPhase::kBounding, [&](std::size_t i, Triangles& triangles) -> Result<void> {
        triangles.sort();
        if (regions_)
          if (const auto added = regions_->add(triangles); !added) return added;
        auto built =
            build_patch(triangles, frame_.centre(), shape_, options_.page_bytes, pages_file_);
        if (!built) return built.error();
        patches_[i] = *std::move(built);
        return {};
      });
}

// Only where winding numbers are constant off the surface.
Result<void> TreeBuild::colour_cells() {
  if (!regions_) return {};
  PhaseCount count(progress_, BuildPhase::kColouring, regions_->touched_count());
  mask_.emplace(options_.page_bytes, frame_.float64, pages_file_);
  const auto built = mask_->build(*regions_, *runs_, [&count] { count.add(); });
  regions_.reset();
  return built;
}

Result<BuildReport> TreeBuild::write_pages() {
  Crown crown = build_crown(above_, patches_, shape_, options_.page_bytes);
  const PageNumbers numbers(crown, patches_, options_.page_bytes);
  if (const auto checked = numbers.check(); !checked) return checked.error();
  const TreePages pages(crown, patches_, numbers, shape_, pages_file_);
  place_ = BuildPlace::kOutput;
  auto writer = storage::PageWriter::create(output_, pages.size() + mask_pages(), options_.replace,
                                            seams_.calls);
  if (!writer) return writer.error();
  PageAppender appender(*writer, progress_, pages.size() + mask_pages());
  const auto appended =
      appender.append(pages.size(), [&](std::uint32_t page) { return pages.encode(page); });
  if (!appended) return appended.error();
  writer->begin_mask();
  const auto masked = appender.append(
      mask_pages(), [&](std::uint32_t page) { return mask_->encode(page, pages.size()); });
  if (!masked) return masked.error();
  storage::ModelRecord model = describe(pages.root_link());
  model.node_count = crown.tree.nodes.size();
  model.height = crown.tree.nodes.empty() ? patches_[0].height : crown.tree.nodes[0].height;
  for (const BuiltPatch& patch : patches_) {
    model.node_count += patch.node_count;
    model.block_count += patch.block_count;
  }
  const auto header = writer->finish(model, options_.page_bytes);
  if (!header) return header.error();
  return BuildReport{*header, frame_.first_set_aside_text,
                     file_.disk_bytes() + pages_file_.disk_bytes()};
}

storage::ModelRecord TreeBuild::describe(std::uint32_t root_link) const {
  storage::ModelRecord model{};
  model.triangle_count = frame_.triangle_count;
  model.set_aside_count = frame_.set_aside_count;
  model.first_set_aside = frame_.first_set_aside;
  model.vertex_count = vertex_records_;
  const Point centre = frame_.centre(), sample = frame_.scaled(frame_.input_sample);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    model.box_lower[axis] = frame_.input_lower[axis];
    model.box_upper[axis] = frame_.input_upper[axis];
    model.centre[axis] = centre[axis];
    model.sample[axis] = sample[axis];
  }
  model.sample_triangle = frame_.sample_triangle;
  model.scale_exponent = frame_.scale_exponent;
  model.root_link = root_link;
  model.vertex_kind =
      shape_.float64 ? storage::VertexKind::kFloat64 : storage::VertexKind::kFloat32;
  model.triangle_id_bytes = shape_.wide_ids ? 8 : 4;
  edges_.describe(frame_.scale_exponent, model);
  model.mask_page_count = mask_pages();
  if (mask_) {
    model.mask_cell_count = mask_->cell_count();
    model.mask_levels = static_cast<std::uint8_t>(mask_->levels());
  }
  return model;
}

}  // namespace

std::filesystem::path BuildOptions::spill_directory(const std::filesystem::path& output) const {
  return temp_directory.empty() ? directory_of(output) : temp_directory;
}

Result<BuildReport> build_tree(const std::filesystem::path& input,
                               const std::filesystem::path& output, const BuildOptions& options,
                               BuildProgress& progress, const BuildSeams& seams) {
  if (!std::has_single_bit(options.page_bytes) || options.page_bytes < storage::kMinPageBytes ||
      options.page_bytes > storage::kMaxPageBytes)
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "a page of %u bytes; use a power of two from 4K to 256K", options.page_bytes);
  const auto memory = seams.memory ? Result<BuildMemory>(*seams.memory)
                                   : BuildMemory::share(options.memory_bytes, options.threads);
  if (!memory) return memory.error();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(memory->threads));
  tbb::task_arena arena(memory->threads);
  return arena.execute([&] {
    TreeBuild build(input, output, options, *memory, progress, seams);
    auto report = build.run();
    if (!report) progress.failed_at(build.failed_at());
    return report;
  });
}

}  // namespace planetree::octree
