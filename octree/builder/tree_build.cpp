#include "octree/builder/tree_build.h"

#include <algorithm>
#include <map>
#include <utility>

#include "octree/builder/build_identity.h"
#include "octree/builder/job/input_paths.h"
#include "octree/builder/job/phase_count.h"
#include "octree/builder/mesh/mesh_format.h"
#include "octree/builder/sort/each_chunk.h"
#include "octree/builder/sort/triangle_spool.h"
#include "octree/builder/space_need.h"
#include "octree/builder/surface_pass.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {

Result<BuildReport> TreeBuild::run() {
  if (const auto resumed = resume_work(); !resumed) return resumed.error();
  if (const auto enough = estimate_size(); !enough) return enough.error();
  if (const auto ordered = order_triangles(); !ordered) return ordered.error();
  if (const auto looked = look_at_surface(); !looked) return looked.error();
  if (const auto cut = cut_out_part(); !cut) return cut.error();
  if (const auto built = build_chunks(); !built) return built.error();
  return finish();
}

void TreeBuild::report_failure() const {
  const auto [directory, path] =
      files_.failed_at().value_or(writing_ ? std::pair(BuildDirectory::kOutput, output_)
                                           : std::pair(BuildDirectory::kInput, failed_input()));
  progress_.failed_at(directory, path);
}

std::filesystem::path TreeBuild::failed_input() const {
  if (!files_.mesh().file().empty()) return files_.mesh().file();
  return failed_input_.empty() ? path_of(input_) : failed_input_;
}

Result<void> TreeBuild::resume_work() {
  if (!options_.resume) return {};
  const auto identity = BuildIdentity::of(input_, options_, seams_, &failed_input_);
  if (!identity) return identity.error();
  if (const auto told = progress_.progress(BuildPhase::kResuming, 0, 1); !told) return told;
  const auto resumed = files_.resume_work(*identity);
  if (resumed) progress_.resumes(files_.work()->start());
  return resumed;
}

// Checks the space before a day of work rather than after it.
Result<void> TreeBuild::estimate_size() {
  const auto size = MeshSize::estimate(input_, seams_.calls, {options_.float64}, &failed_input_);
  return size ? check_space(*size) : size.error();
}

// Adds the content of a compressed file to what is known of the others.
Result<void> TreeBuild::estimate_unpacked(const MeshFile& content) {
  const auto size =
      MeshSize::estimate(content, unpacked_path(files_.mesh().file()), {options_.float64});
  if (!size) return size.error();
  MeshSize sum = size_;
  sum.unpacked_bytes = 0;  // of contents that are there already, or are checked when they are read
  sum.add(*size);
  return check_space(sum);
}

// What the files before one that was unpacked have taken does not count again.
Result<void> TreeBuild::check_space(const MeshSize& size) {
  size_ = size;
  size_.attributes = options_.kept_attributes();
  if (files_.work() && files_.work()->mesh()) return {};  // its triangles are counted
  SpaceNeed need = SpaceNeed::before_reading(size_, memory_, options_.box.has_value());
  need.temporary_bytes -= std::min(need.temporary_bytes, files_.scratch().disk_bytes());
  return files_.check_space(need);
}

Result<void> TreeBuild::order_triangles() {
  const bool ordered_before = files_.work() && files_.work()->mesh();
  if (const auto ordered = ordered_before ? resume_mesh() : read(); !ordered) return ordered;
  auto above = cut_chunks(*whole_, model_.frame.has_strays(), seams_.chunk_triangles);
  if (!above) return above.error();
  model_.above = *std::move(above);
  return {};
}

Result<void> TreeBuild::resume_mesh() {
  const OrderedMesh& mesh = *files_.work()->mesh();
  const auto set =
      set_mesh(mesh, files_.work()->resumed_bytes(), files_.work()->surface().has_value());
  if (!set) return set;
  whole_.emplace(mesh.frame.float64, 0, files_.triangles());
  whole_->add_extent(mesh.runs);
  return {};
}

Result<void> TreeBuild::read() {
  TriangleSpool spool(memory_.batch_triangles, memory_.spool_bytes, files_.scratch());
  files_.mesh().before_sorting([this] {
    return files_.check_space(SpaceNeed::before_sorting(
        size_, memory_, files_.scratch().disk_bytes(), options_.box.has_value()));
  });
  files_.mesh().before_unpacking([this](auto bytes) { return files_.check_space({bytes, 0}); });
  files_.mesh().after_unpacking(
      [this](const MeshFile& content) { return estimate_unpacked(content); });
  auto mesh = read_unordered(input_, options_, files_.mesh(), progress_, spool, files_.triangles());
  if (!mesh) return mesh.error();
  if (const auto set = set_mesh(*mesh, 0, false); !set) return set;
  whole_.emplace(mesh->frame.float64, memory_.runs_bytes, files_.triangles());
  PhaseCount count(progress_, BuildPhase::kOrdering, spool.batch_count());
  if (const auto taken = whole_->take(spool, [&count] { return count.add(); }); !taken)
    return taken;
  if (files_.work()) mesh->runs = whole_->extents();
  return keep(*mesh);
}

// Also checks the space again, now that the triangles are counted.
Result<void> TreeBuild::set_mesh(const OrderedMesh& mesh, std::uint64_t kept_bytes, bool matched) {
  model_.frame = mesh.frame;
  notes_ = mesh.notes;
  model_.box = options_.box;
  model_.vertex_records = mesh.vertex_records;
  model_.shape.float64 = mesh.frame.float64;
  model_.shape.wide_ids = mesh.wide_ids;
  model_.attributes = KeptAttributes::of(mesh, options_, files_.triangles());
  if (model_.box)
    if (const auto near = model_.box->check_meets(model_.frame); !near) return near;
  // A callback need not say its size. A closed surface has half as many vertices as triangles.
  const std::uint64_t vertices =
      size_.vertices > 0 ? size_.vertices : mesh.frame.triangle_count / 2;
  size_ = {mesh.frame.triangle_count, vertices, mesh.frame.float64, false, 0, size_.attributes};
  return files_.check_space(
      SpaceNeed::after_reading(size_, memory_, kept_bytes, matched, model_.box.has_value()));
}

Result<void> TreeBuild::look_at_surface() {
  if (model_.box) part_.emplace(model_.shape.float64, memory_.part_bytes, files_.triangles());
  caps_.emplace(model_.frame, model_.shape, options_.page_bytes, memory_.cap_bytes,
                files_.triangles(), files_.pages());
  const Checkpoint* const work = files_.work();
  if (work && work->surface()) {
    model_.edges = work->surface()->edges;
    model_.cut = work->surface()->cut;
    caps_->resume(work->surface()->caps);
    model_.openness = work->surface()->openness;
    if (part_) part_->add_extent(work->surface()->kept);
  } else if (const auto matched = match_edges(); !matched) {
    return matched;
  }
  if (!model_.box) take_whole_surface();
  return {};
}

void TreeBuild::take_whole_surface() {
  model_.cut.triangle_count = model_.frame.triangle_count;
  model_.cut.sample_triangle = model_.frame.sample_triangle;
  model_.cut.sample = model_.frame.scaled(model_.frame.input_sample);
}

Result<void> TreeBuild::match_edges() {
  const SurfacePass pass{model_.frame, *whole_, model_.above.chunks, part_ ? &*part_ : nullptr,
                         options_.has_side_layer() ? &*caps_ : nullptr};
  auto found = pass.run(region(), memory_, files_.scratch(), progress_);
  if (!found) return found.error();
  model_.edges = found->edges;
  model_.cut = found->cut;
  model_.openness = found->openness;
  if (!files_.work()) return {};
  if (part_) found->kept = part_->extents();
  found->caps = caps_->work();
  return keep(*found);
}

// The rest of the input is not needed from here on.
Result<void> TreeBuild::cut_out_part() {
  if (!part_) return {};
  whole_.reset();
  if (part_->size() == 0) return no_triangle_touches(model_.frame);
  auto above = cut_chunks(*part_, model_.frame.has_strays(), seams_.chunk_triangles);
  if (!above) return above.error();
  model_.above = *std::move(above);
  const std::uint64_t triangles = part_->size();
  const MeshSize part{triangles, std::min(size_.vertices, 3 * triangles), size_.float64};
  // Of the resumed bytes, all but those of triangles count.
  const std::uint64_t record = Triangles::record_bytes(size_.float64);
  const std::uint64_t kept_bytes = files_.work() ? files_.work()->resumed_bytes() : 0;
  const std::uint64_t of_triangles = record * (size_.triangles + triangles);
  return files_.check_space(
      SpaceNeed::after_cutting(part, memory_, kept_bytes - std::min(kept_bytes, of_triangles)));
}

// Without sides there are no sectors, and no caps in them.
Result<void> TreeBuild::divide_sectors() {
  if (!options_.has_side_layer()) return {};
  sectors_.emplace(model_.frame.core_lower(), region(), model_.cut.winding, model_.frame.float64,
                   memory_.visitor_bytes, files_.triangles());
  if (const auto divided = sectors_->divide(runs(), caps_->runs(), model_.frame.has_strays(),
                                            seams_.sector_triangles);
      !divided)
    return divided;
  return caps_->build(*sectors_, seams_.chunk_triangles);
}

Result<void> TreeBuild::build_chunks() {
  if (const auto divided = divide_sectors(); !divided) return divided;
  model_.chunks.resize(model_.above.chunks.size());
  resume_chunks();
  return for_each_chunk(
      runs(), model_.above.chunks, progress_, BuildPhase::kBuildingTree,
      [&](std::size_t i) { return !model_.chunks[i].pages.empty(); },
      [&](std::size_t i, Triangles& triangles) { return build(i, triangles); });
}

void TreeBuild::resume_chunks() {
  if (!files_.work()) return;
  for (std::uint32_t i = 0; i < model_.chunks.size(); ++i) {
    auto chunk = files_.work()->take_chunk(i);
    if (!chunk || (sectors_ && !sectors_->add_extent(chunk->part))) continue;
    model_.chunks[i] = std::move(chunk->built);
  }
}

Result<void> TreeBuild::build(std::size_t number, Triangles& triangles) {
  triangles.sort();
  ChunkWork chunk;
  if (sectors_) {
    auto part = sectors_->add(triangles);
    if (!part) return part.error();
    chunk.part = *std::move(part);
  }
  auto built = build_chunk(triangles, model_.chunks.size() == 1, model_.frame.centre(),
                           model_.shape, options_.page_bytes, files_.pages());
  if (!built) return built.error();
  chunk.built = *std::move(built);
  if (const auto kept = keep(static_cast<std::uint32_t>(number), chunk); !kept) return kept;
  model_.chunks[number] = std::move(chunk.built);
  return {};
}

Result<void> TreeBuild::number_pages() {
  tree_.emplace(model_.frame, model_.above, model_.chunks, model_.shape, options_.page_bytes,
                files_.pages());
  if (const auto checked = tree_->check(); !checked) return checked;
  return caps_->number_pages(tree_->pages().size());
}

Result<void> TreeBuild::colour_cells() {
  if (!sectors_ || sectors_->touched_count() == 0) return {};
  model_.mask.emplace(options_.page_bytes, model_.frame.float64, files_.pages());
  auto earlier =
      files_.work() ? files_.work()->take_sectors() : std::map<std::uint32_t, BuiltSector>();
  PhaseCount count(progress_, BuildPhase::kBuildingMask, sectors_->touched_count(), earlier.size());
  for (auto& [number, region] : earlier) model_.mask->resume(number, std::move(region));
  const auto done = [&](std::uint32_t number, const BuiltSector& region) {
    const auto kept = keep(number, region);
    return kept ? count.add() : kept;
  };
  const BuiltTrees trees(&*tree_, caps_->tree());
  const auto built = model_.mask->build(*sectors_, runs(), trees, done);
  sectors_.reset();
  return built;
}

Result<BuildReport> TreeBuild::write_pages() {
  if (options_.has_field_layer()) {
    auto field = BuiltField::build(BuiltTrees(&*tree_, caps_->tree()), region(),
                                   model_.cut.triangle_count, options_.page_bytes, progress_);
    if (!field) return field.error();
    model_.field = *std::move(field);
  }
  writing_ = true;
  const auto header = write_tree(model_, *tree_, *caps_, output_, options_, seams_.calls,
                                 files_.scratch(), progress_);
  if (!header) return header.error();
  if (const auto removed = files_.remove_work(); !removed) return removed.error();
  return BuildReport{*header, model_.frame, files_.disk_bytes(), notes_, options_.metadata};
}

Result<BuildReport> TreeBuild::finish() {
  if (const auto numbered = number_pages(); !numbered) return numbered.error();
  if (const auto coloured = colour_cells(); !coloured) return coloured.error();
  part_.reset();
  whole_.reset();
  return write_pages();
}

}  // namespace planetree::octree
