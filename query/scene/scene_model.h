#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "planetree/error.h"
#include "planetree/scene.h"
#include "query/file/open_layers.h"
#include "query/probe_state.h"
#include "query/scene/scene_pager.h"
#include "query/serve/query_arena.h"
#include "query/serving_model.h"
#include "storage/file/page_file.h"
#include "storage/system/file_calls.h"

namespace planetree::query {

/// A file that is open in a scene, with the memory that queries read besides its pages.
struct SceneModel {
  struct Choices {
    std::uint32_t layers = kAllLayers;
    std::uint32_t max_page_bytes = 0;
    std::uint64_t max_field_bytes = 0;
    unsigned readers = 0;        ///< of the cache: fetch threads, one that loads files, probes
    unsigned fetch_threads = 0;  ///< of them
    Locking locking = Locking::kTry;
    cache::FetchTerms query_terms, fetcher_terms;
    std::span<octree::ContactTriangles> contacts;  ///< of the scene, one for each probe
  };

  SceneModel(storage::PageFile its_file, const OpenLayers& its_layers, const ModelInfo& its_info)
      : file(std::move(its_file)), opened(its_layers), info(its_info) {}

  /// Opens a file; join() must follow.
  ///
  /// calls   must outlive the model
  /// errors  those of Model::open; kBadArgument: the pages are greater than max_page_bytes
  static Result<std::unique_ptr<SceneModel>> open(const std::filesystem::path& path,
                                                  const Choices& choices,
                                                  storage::FileCalls& calls);
  /// Joins a scene: adds the pages to its cache, claims the memory, reads grids and field, and
  /// makes the probes.
  ///
  /// loader  reader of the cache, for this call
  Result<void> join(ScenePager& pager, cache::Reader& loader, const Choices& choices);
  /// Leaves the scene, where nobody uses the model any more. Frees the memory.
  void leave(ScenePager& pager) noexcept;

  /// Probes of fetch threads, for the reader indices from 0 on.
  std::vector<std::unique_ptr<FetchProbe>> fetch_probes(cache::PageCache& cache,
                                                        unsigned count) const;
  /// The probe with the index of a reader of the cache that no fetch thread has.
  ProbeState& probe(std::uint32_t reader) const noexcept { return *probes[reader]; }
  /// Memory besides the pages.
  ModelMemory memory(const Choices& choices) const noexcept;

  /// What the arena needs.
  QueryArena::Needs needs(const Choices& choices) const noexcept;

  storage::PageFile file;
  OpenLayers opened;
  ModelInfo info;
  std::uint32_t instances = 0;
  std::optional<std::uint32_t> first_page;  ///< number that the cache has for page 0; if joined
  std::optional<QueryArena> arena;
  ServingModelPtr serving;
  std::vector<std::unique_ptr<ProbeState>>
      probes;               ///< indexed by reader; null below the first probe
  std::uint64_t bytes = 0;  ///< of memory()
};

}  // namespace planetree::query
