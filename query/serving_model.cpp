#include "query/serving_model.h"

#include <algorithm>
#include <memory>
#include <new>

#include "query/file/field_loading.h"
#include "query/file/page_decoding.h"
#include "query/probe_state.h"
#include "query/serve/page_accessor.h"

namespace planetree::query {
namespace {

void fill_grids(ServingModel& serving, cache::Reader& reader, const TableLimits& limits) {
  PageAccessor accessor(reader, Wait::kForPages);
  accessor.set_trace(serving.page_trace(reader.index()));
  ModelGeometry& geometry = serving.geometry;
  std::span<std::byte> memory = serving.arena.side_grid;
  if (geometry.tree.caps && limits.fills_cap_grid) {
    geometry.cap_grid.fill(geometry.caps, geometry.tree, accessor.pages(),
                           memory.first(octree::CapGrid::kBytes));
    memory = memory.subspan(octree::CapGrid::kBytes);
  }
  if (!limits.fills_side_grid) return;
  geometry.side_grid.fill(geometry.mask, geometry.tree, geometry.cap_grid,
                          geometry.region.has_walls(), geometry.scale.exponent(), accessor.pages(),
                          memory);
}

std::uint64_t stored_bytes_of(const storage::FileHeader& header, storage::PageKind kind) noexcept {
  return header.stored_bytes[static_cast<unsigned>(kind)];
}

}  // namespace

TableLimits remote_limits(const storage::FileHeader& header) noexcept {
  TableLimits limits;
  limits.fills_side_grid =
      stored_bytes_of(header, storage::PageKind::kMask) <= kMaxRemoteTableBytes;
  limits.fills_cap_grid = stored_bytes_of(header, storage::PageKind::kCaps) <= kMaxRemoteTableBytes;
  return limits;
}

std::uint32_t remote_layers(const storage::FileHeader& header, std::uint32_t wanted) noexcept {
  const bool is_large = stored_bytes_of(header, storage::PageKind::kField) > kMaxRemoteTableBytes;
  return is_large ? wanted & ~kFieldLayer : wanted;
}

QueryArena::Needs arena_needs(const storage::FileHeader& header, const OpenLayers& opened,
                              unsigned readers, const TableLimits& limits) noexcept {
  QueryArena::Needs needs;
  needs.readers = readers;
  needs.model_bytes = sizeof(ServingModel);
  needs.probe_bytes = sizeof(ProbeState);
  if (opened.has_side() && header.model.mask_page_count > 0 && limits.fills_side_grid)
    needs.side_grid_bytes = std::min<std::uint64_t>(
        octree::SideGrid::bytes(header.model.triangle_count), limits.grid_bytes);
  if (opened.has_side() && header.model.cap_count > 0 && limits.fills_cap_grid)
    needs.side_grid_bytes += octree::CapGrid::kBytes;
  if (opened.has_field()) {
    const octree::FieldShape shape = field_shape(header.model);
    needs.field_bytes = shape.thinned(shape.thinning_for(limits.field_bytes)).bytes();
  }
  return needs;
}

ServingModelPtr make_serving_model(const storage::FileHeader& header, const OpenLayers& opened,
                                   cache::PageCache& cache, const QueryArena::Parts& arena) {
  ServingModelPtr serving(::new (arena.model.data()) ServingModel(header, opened, cache, arena));
  const std::size_t contacts = arena.contacts.size() / sizeof(octree::ContactTriangles);
  auto* const first = reinterpret_cast<octree::ContactTriangles*>(arena.contacts.data());
  std::uninitialized_value_construct_n(first, contacts);
  serving->contacts = {first, contacts};
  return serving;
}

Result<LoadedModel> load_model(ServingModel& serving, const storage::PageFile& file,
                               const OpenLayers& opened, cache::Reader& reader,
                               const TableLimits& limits) {
  if (opened.has_side()) fill_grids(serving, reader, limits);
  if (!opened.has_field()) return LoadedModel{};
  const octree::FieldShape shape = field_shape(file.header().model);
  const std::uint32_t thinning = shape.thinning_for(limits.field_bytes);
  const auto field = load_field(file, thinning, serving.arena.field);
  if (!field) return field.error();
  ModelGeometry& geometry = serving.geometry;
  geometry.field.fill(shape.thinned(thinning), field->points,
                      geometry.tree.has_strays || geometry.region.has_walls());
  return LoadedModel{field->is_damaged};
}

}  // namespace planetree::query
