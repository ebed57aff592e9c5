#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "cache/page_cache.h"
#include "cache/reader.h"
#include "planetree/error.h"
#include "query/answer/contact_set.h"
#include "query/answer/model_geometry.h"
#include "query/serve/page_trace.h"
#include "query/serve/query_arena.h"
#include "storage/file/page_file.h"

namespace planetree::query {

class BatchThreads;
class ProbeState;

/// The state of an open model that queries read besides its pages. It lies in the model's
/// QueryArena, so that no query causes a page fault. Any number of threads may read it.
struct ServingModel {
  ServingModel(const storage::FileHeader& header, const OpenLayers& opened,
               cache::PageCache& its_cache, const QueryArena::Parts& its_arena)
      : geometry(header, opened), cache(its_cache), arena(its_arena) {}

  ModelGeometry geometry;
  cache::PageCache& cache;
  const QueryArena::Parts arena;
  cache::FetchTerms query_terms{};        ///< how queries wait for pages
  cache::FetchTerms fetcher_terms{};      ///< how fetch threads wait for pages
  BatchThreads* batch_threads = nullptr;  ///< null: batches run on the caller's thread
  std::span<const std::unique_ptr<ProbeState>> batch_probes;  ///< one per thread of batch_threads
  const storage::PageFile* remote_file = nullptr;             ///< null: the file is of this machine
  std::span<octree::ContactTriangles> contacts;               ///< see contact_triangles()
  std::uint32_t contacts_reader = 0;                          ///< reader index of the first of them
  mutable std::atomic<std::uint64_t> degraded{0};             ///< number of degraded answers
  mutable std::atomic<std::uint64_t> degraded_without_misses{0};  ///< of these, lacking no page

  /// Counts a degraded answer.
  ///
  /// missed  its query lacked a page
  void count_degraded(bool missed) const noexcept {
    degraded.fetch_add(1, std::memory_order_relaxed);
    if (!missed) degraded_without_misses.fetch_add(1, std::memory_order_relaxed);
  }

  /// Memory for one query for contacts of the probe with this reader index.
  octree::ContactTriangles& contact_triangles(std::uint32_t reader) const noexcept {
    return contacts[reader - contacts_reader];
  }
  /// `reader` is the reader index of a probe.
  FetchRequests& requests(std::uint32_t reader) const noexcept {
    return arena.fetch_requests[reader];
  }
  /// The trace of the probe with this reader index, or null if there is none.
  PageTrace* page_trace(std::uint32_t reader) const noexcept {
    return arena.traces ? &arena.traces->of_readers[reader] : nullptr;
  }
};

/// Destroys a ServingModel without freeing its memory, which is the arena's.
struct DestroyServingModel {
  void operator()(ServingModel* serving) const noexcept { serving->~ServingModel(); }
};
using ServingModelPtr = std::unique_ptr<ServingModel, DestroyServingModel>;

/// Maximum sizes of the tables of a model.
struct TableLimits {
  /// Of the side grid: it takes the finest level that fits.
  std::uint64_t grid_bytes = std::numeric_limits<std::uint64_t>::max();
  /// Of the coarse field: it is thinned as far as that is possible (FieldShape::thinning_for).
  std::uint64_t field_bytes = std::numeric_limits<std::uint64_t>::max();
  bool fills_side_grid = true;  ///< false: there is none, so that its pages need not be read
  bool fills_cap_grid = true;   ///< likewise
};

/// Returns limits of the tables of a file on another machine: none is filled that takes more than
/// about kMaxRemoteTableBytes of the file.
TableLimits remote_limits(const storage::FileHeader& header) noexcept;
inline constexpr std::uint64_t kMaxRemoteTableBytes = std::uint64_t{1} << 17;

/// Returns those of the layers `wanted` that a remote file opens: not the field, if it is large.
std::uint32_t remote_layers(const storage::FileHeader& header, std::uint32_t wanted) noexcept;

/// Returns what the arena of a model needs for so many readers, without contacts and traces.
QueryArena::Needs arena_needs(const storage::FileHeader& header, const OpenLayers& opened,
                              unsigned readers, const TableLimits& limits = {}) noexcept;

/// Makes a model in its arena. load_model() must fill it before queries use it.
///
/// arena  of arena_needs(); must outlive the model, as `cache` must
ServingModelPtr make_serving_model(const storage::FileHeader& header, const OpenLayers& opened,
                                   cache::PageCache& cache, const QueryArena::Parts& arena);

/// What load_model() found.
struct LoadedModel {
  bool field_is_damaged = false;  ///< a page of the field is unreadable, so that it has none
};
/// Reads what queries need besides pages: the side grid, the cap grid and the coarse field.
///
/// reader  of the model's pages, which are numbered from 0
/// limits  those of arena_needs()
/// errors  kNoMemory
Result<LoadedModel> load_model(ServingModel& serving, const storage::PageFile& file,
                               const OpenLayers& opened, cache::Reader& reader,
                               const TableLimits& limits = {});

}  // namespace planetree::query
