#include "query/scene/scene_model.h"

#include <algorithm>
#include <new>
#include <utility>

#include "query/file/model_info.h"
#include "query/file/scene_frames.h"
#include "query/file/tree_header.h"
#include "storage/set/open_model.h"

namespace planetree::query {
namespace {

// Maximum size of a side grid. The grid of a large model alone has six times as much.
constexpr std::uint64_t kMaxGridBytes = std::uint64_t{1} << 18;

TableLimits table_limits(const storage::PageFile& file, const SceneModel::Choices& choices) {
  TableLimits limits = file.source().is_remote() ? remote_limits(file.header()) : TableLimits{};
  limits.grid_bytes = kMaxGridBytes;
  limits.field_bytes = choices.max_field_bytes;
  return limits;
}

std::uint64_t thread_bytes(const SceneModel::Choices& choices) {
  const std::uint64_t for_each =
      sizeof(FetchWorker) + sizeof(QueryingFetchProbe) + choices.readers * FetchWorker::kProbeBytes;
  return choices.fetch_threads * for_each;
}

Error no_memory() {
  return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                    "no memory to open the model; free some and try again");
}

}  // namespace

Result<std::unique_ptr<SceneModel>> SceneModel::open(const std::filesystem::path& path,
                                                     const Choices& choices,
                                                     storage::FileCalls& calls) {
  auto source = storage::open_model_source(path, {}, calls);
  if (!source) return source.error();
  auto file = storage::PageFile::open(std::move(*source));
  if (!file) return file.error();
  const storage::FileHeader& header = file->header();
  if (const auto checked = check_tree_header(header); !checked) return checked.error();
  const std::uint32_t most = choices.max_page_bytes;
  const std::uint32_t needed = frame_bytes_for(header);
  if (needed > most)
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "the file has pages of %u bytes, the scene frames of %u: create the scene "
                      "with a max_page_bytes of at least %u",
                      needed, most, needed);
  const std::uint32_t wanted = choices.layers & ~std::uint32_t{kAttributeLayer};
  const OpenLayers opened = OpenLayers::of(
      header.model, file->source().is_remote() ? remote_layers(header, wanted) : wanted);
  const ModelInfo info = describe(*file);
  std::unique_ptr<SceneModel> model(new (std::nothrow) SceneModel(*std::move(file), opened, info));
  if (!model) return no_memory();
  return model;
}

QueryArena::Needs SceneModel::needs(const Choices& choices) const noexcept {
  return arena_needs(file.header(), opened, choices.readers, table_limits(file, choices));
}

ModelMemory SceneModel::memory(const Choices& choices) const noexcept {
  const QueryArena::Needs needs = this->needs(choices);
  ModelMemory memory;
  memory.directory = file.memory_bytes();
  memory.side_grid = needs.side_grid_bytes;
  memory.field = needs.field_bytes;
  memory.probes = choices.readers * (needs.probe_bytes + sizeof(FetchRequests) +
                                     sizeof(std::unique_ptr<ProbeState>)) +
                  thread_bytes(choices);
  memory.total = file.memory_bytes() + QueryArena::bytes(needs) + sizeof(SceneModel) +
                 choices.readers * sizeof(std::unique_ptr<ProbeState>) + thread_bytes(choices);
  memory.other = memory.total - memory.directory - memory.side_grid - memory.field - memory.probes;
  return memory;
}

Result<void> SceneModel::join(ScenePager& pager, cache::Reader& loader, const Choices& choices) {
  bytes = memory(choices).total;
  const auto first = pager.add(file, opened.page_count(file.header()), bytes);
  if (!first) return first.error();
  first_page = *first;
  cache::PageCache& cache = pager.cache();
  auto claimed = QueryArena::claim(needs(choices));
  if (!claimed) return claimed.error();
  arena.emplace(*std::move(claimed));
  if (choices.locking != Locking::kNever && !arena->lock() && choices.locking == Locking::kRequire)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "the system does not let memory be locked; raise the limit (ulimit -l) or "
                      "create the scene without locking");
  try {
    serving = make_serving_model(file.header(), opened, cache, arena->parts());
    serving->query_terms = choices.query_terms;
    serving->fetcher_terms = choices.fetcher_terms;
    serving->contacts = choices.contacts;
    serving->contacts_reader = choices.fetch_threads + 1;
    cache::Reader window = cache.window(loader.index(), *first);
    if (const auto loaded = load_model(*serving, file, opened, window, table_limits(file, choices));
        !loaded)
      return loaded.error();
    probes.resize(choices.readers);
    for (unsigned reader = choices.fetch_threads + 1; reader < choices.readers; ++reader)
      probes[reader] = ProbeState::create(*serving, cache.window(reader, *first));
  } catch (const std::bad_alloc&) {
    return no_memory();
  }
  return {};
}

void SceneModel::leave(ScenePager& pager) noexcept {
  probes.clear();
  serving.reset();
  arena.reset();
  if (first_page) pager.remove(*std::exchange(first_page, {}), bytes);
}

std::vector<std::unique_ptr<FetchProbe>> SceneModel::fetch_probes(cache::PageCache& cache,
                                                                  unsigned count) const {
  std::vector<std::unique_ptr<FetchProbe>> made;
  for (unsigned reader = 0; reader < count; ++reader)
    made.push_back(
        std::make_unique<QueryingFetchProbe>(*serving, cache.window(reader, *first_page)));
  return made;
}

}  // namespace planetree::query
