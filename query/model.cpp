#include "planetree/model.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <optional>
#include <utility>

#include "octree/geometry/fp_environment.h"
#include "octree/geometry/octcode.h"
#include "octree/geometry/startup_check.h"
#include "query/answer/mesh_triangle.h"
#include "query/file/model_info.h"
#include "query/model_state.h"
#include "query/probe_state.h"
#include "query/serve/cache_counts.h"
#include "query/serve/page_accessor.h"
#include "query/serve/trace_decoder.h"
#include "storage/file/metadata.h"
#include "storage/set/open_model.h"

namespace planetree {
namespace query {
namespace {

Result<void> check_options(const OpenOptions& options) {
  const auto check = [](unsigned count, const char* what, unsigned most) -> Result<void> {
    if (count >= 1 && count <= most) return {};
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "%u %s are not possible; give 1 to %u", count, what, most);
  };
  for (const Result<void>& checked :
       {check(options.batch_threads, "batch threads", OpenOptions::kMaxBatchThreads),
        check(options.fetch_threads, "fetch threads", OpenOptions::kMaxFetchThreads),
        check(options.max_probes, "probes", OpenOptions::kMaxProbes),
        check(std::max(options.page_trace_capacity, 1U), "accesses of a trace",
              OpenOptions::kMaxPageTraceCapacity)})
    if (!checked) return checked;
  if (options.policy > EvictionPolicy::kTwoQ)
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "the eviction policy %u does not exist; choose a value of EvictionPolicy",
                      static_cast<unsigned>(options.policy));
  if ((options.layers & ~kAllLayers) == 0) return {};
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "layers are 0x%x; combine kSideLayer, kFieldLayer and kAttributeLayer",
                    options.layers);
}

// Returns the number of probes of the model's own threads.
unsigned thread_probes(const OpenOptions& options) {
  return options.fetch_threads + (options.batch_threads > 1 ? options.batch_threads : 0);
}

// Model::triangles() has a reader of its own, without a probe.
unsigned finders(const OpenLayers& opened) { return opened.has_attributes() ? 1 : 0; }

// Opens a file, a set or a URL.
Result<storage::PageFile> open_page_file(const std::filesystem::path& path,
                                         const OpenOptions& options, const ModelSeams& seams) {
  storage::ModelSourceOptions how;
  how.http.cache_directory = options.http_cache;
  how.http.cache_bytes = options.http_cache_bytes;
  how.http.limits = seams.http_limits;
  how.allows_missing_members = options.allow_missing_members;
  auto source = storage::open_model_source(path, how, seams.calls);
  if (!source) return source.error();
  return storage::PageFile::open(std::move(*source));
}

TableLimits table_limits_of(const storage::PageFile& file) {
  return file.source().is_remote() ? remote_limits(file.header()) : TableLimits{};
}

// Gets the upper pages of tree and mask, which are the first of their kinds in the file.
void prefetch_first_pages(const storage::PageFile& file, const OpenLayers& opened) {
  const storage::FileHeader& header = file.header();
  const std::uint32_t first_mask_page = header.first_mask_page();
  if (!opened.has_side() || first_mask_page == header.page_count) return;
  file.prefetch({&first_mask_page, 1});
}

Pager::Limits limits_of(const storage::PageFile& file, const OpenOptions& options) {
  const storage::FileHeader& header = file.header();
  const std::uint32_t layers =
      file.source().is_remote() ? remote_layers(header, options.layers) : options.layers;
  Pager::Limits limits;
  limits.budget_bytes = options.memory_budget_bytes;
  limits.opened = OpenLayers::of(header.model, layers);
  limits.max_probes = options.max_probes;
  limits.probe_bytes = sizeof(BatchBuffers);
  limits.thread_probes = thread_probes(options) + finders(limits.opened);
  limits.thread_bytes = sizeof(ModelState) +
                        limits.thread_probes * (sizeof(QueryingFetchProbe) + sizeof(void*)) +
                        options.fetch_threads * FetchThreads::kThreadBytes +
                        limits.readers() * FetchWorker::kProbeBytes * options.fetch_threads;
  limits.locking = options.locking;
  limits.wait_limit = std::chrono::milliseconds(options.wait_limit_ms);
  limits.use_io_uring = options.use_io_uring;
  limits.policy = options.policy;
  limits.arena = arena_needs(header, limits.opened, limits.readers(), table_limits_of(file));
  limits.arena.contact_bytes = sizeof(octree::ContactTriangles);
  limits.arena.page_trace_capacity = options.page_trace_capacity;
  limits.arena.page_count = limits.opened.page_count(header);
  return limits;
}

static_assert(OpenOptions::kMaxProbes + OpenOptions::kMaxFetchThreads +
                  OpenOptions::kMaxBatchThreads <=
              cache::kMaxReaders);

}  // namespace

ModelState::ModelState(std::unique_ptr<Pager> pager)
    : pager_(std::move(pager)),
      info_(describe(pager_->file())),
      serving_(make_serving_model(pager_->file().header(), pager_->opened(), pager_->cache(),
                                  pager_->query_arena().parts())) {}

ModelState::~ModelState() = default;

Result<void> ModelState::load() {
  if (pager_->file().source().is_remote()) {
    serving_->remote_file = &pager_->file();
    prefetch_first_pages(pager_->file(), pager_->opened());
  }
  auto reader = claim_reader();
  if (!reader) return reader.error();
  const auto loaded = load_model(*serving_, pager_->file(), pager_->opened(), *reader,
                                 table_limits_of(pager_->file()));
  if (!loaded) return loaded.error();
  field_damaged_ = loaded->field_is_damaged;
  return {};
}

Result<void> ModelState::start_threads(const OpenOptions& options, const ModelSeams& seams) {
  const std::chrono::milliseconds wait_limit(options.wait_limit_ms);
  serving_->fetcher_terms = {true, wait_limit};
  serving_->query_terms = {!seams.starts_fetching, wait_limit};
  if (options.batch_threads > 1) {
    auto threads = BatchThreads::create(options.batch_threads);
    if (!threads) return threads.error();
    batch_threads_ = std::move(*threads);
    for (unsigned i = 0; i < options.batch_threads; ++i) {
      auto reader = claim_reader();
      if (!reader) return reader.error();
      batch_probes_.push_back(ProbeState::create(*serving_, std::move(*reader)));
    }
    serving_->batch_probes = batch_probes_;
    serving_->batch_threads = batch_threads_.get();
  }
  if (pager_->opened().has_attributes()) {
    auto reader = claim_reader();
    if (!reader) return reader.error();
    finder_.emplace(*std::move(reader));
  }
  if (!seams.starts_fetching) return {};
  std::vector<std::unique_ptr<FetchProbe>> probes;
  for (unsigned i = 0; i < options.fetch_threads; ++i) {
    auto reader = claim_reader();
    if (!reader) return reader.error();
    probes.push_back(std::make_unique<QueryingFetchProbe>(*serving_, std::move(*reader)));
  }
  if (options.read_ahead && cache().holds_all_pages())
    read_ahead_.emplace(pager_->opened(), pager_->file().header());
  auto fetchers = FetchThreads::start(cache(), options.fetch_threads);
  if (!fetchers) return fetchers.error();
  fetch_threads_ = std::move(*fetchers);
  return fetch_threads_->add(serving_->arena.fetch_requests, std::move(probes),
                             read_ahead_ ? &*read_ahead_ : nullptr);
}

Result<std::unique_ptr<ModelState>> ModelState::open(const std::filesystem::path& path,
                                                     const OpenOptions& options,
                                                     const ModelSeams& seams) {
  if (const auto checked = octree::check_arithmetic(); !checked) return checked.error();
  if (const auto checked = check_options(options); !checked) return checked.error();
  auto file = open_page_file(path, options, seams);
  if (!file) return file.error();
  Pager::Limits limits = limits_of(*file, options);
  limits.trace_time = seams.trace_time;
  auto pager = Pager::create(std::move(*file), limits);
  if (!pager) return pager.error();
  try {
    std::unique_ptr<ModelState> state(new ModelState(std::move(*pager)));
    if (const auto loaded = state->load(); !loaded) return loaded.error();
    if (PageTraces* const traces = state->serving_->arena.traces) traces->finish_open();
    if (const auto started = state->start_threads(options, seams); !started) return started.error();
    return state;
  } catch (const std::bad_alloc&) {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory to open the model; free some and try again");
  }
}

Result<std::uint64_t> ModelState::min_budget_bytes(const std::filesystem::path& path,
                                                   const OpenOptions& options) {
  if (const auto checked = check_options(options); !checked) return checked.error();
  auto file = open_page_file(path, options, {});
  if (!file) return file.error();
  return Pager::min_budget_bytes(*file, limits_of(*file, options));
}

Result<Model> ModelState::open_model(const std::filesystem::path& path, const OpenOptions& options,
                                     const ModelSeams& seams) {
  const octree::FpEnvironmentGuard host;
  auto state = open(path, options, seams);
  if (!state) return state.error();
  return Model(std::move(*state));
}

Result<Metadata> ModelState::metadata() const { return storage::read_metadata(pager_->file()); }

Result<void> ModelState::find_triangles(std::span<const std::uint64_t> indices,
                                        std::span<MeshTriangle> triangles) const noexcept {
  if (!finder_)
    return make_error(ErrorCode::kUnsupported, Error::kNowhere, Error::kNowhere, "%s",
                      info_.attributes == 0
                          ? "the file does not keep where its triangles are; build it with "
                            "--keep triangles"
                          : "the attribute layer is not open; open it with kAttributeLayer");
  if (triangles.size() < indices.size())
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "%zu triangles do not fit in %zu; give as many as indices", indices.size(),
                      triangles.size());
  const octree::FpEnvironmentGuard host;
  const std::lock_guard one(finding_);
  PageAccessor accessor(*finder_, Wait::kForPages, serving_->query_terms);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const auto found = find_mesh_triangle(geometry(), accessor.pages(), indices[i]);
    if (!found) return found.error();
    triangles[i] = *found;
  }
  return {};
}

std::size_t ModelState::drain_page_trace(std::span<PageAccess> accesses) const noexcept {
  PageTraces* const traces = serving_->arena.traces;
  if (!traces) return 0;
  traces->clock.advance();
  return TraceDecoder(*traces, pager_->file()).decode(accesses);
}

Stats ModelState::stats() const noexcept {
  Stats stats;
  report_cache(pager_->cache().stats(), stats);
  stats.degraded_answers = serving_->degraded.load(std::memory_order_relaxed);
  stats.degraded_without_misses = serving_->degraded_without_misses.load(std::memory_order_relaxed);
  if (const PageTraces* const traces = serving_->arena.traces)
    stats.page_trace_dropped = traces->dropped();
  for (const FetchRequests& fetch_requests : serving_->arena.fetch_requests)
    stats.fetch_requests += fetch_requests.missed.store_count();
  if (fetch_threads_) {
    stats.fetch_requests_served = fetch_threads_->fetch_requests_served();
    stats.pages_prefetched = fetch_threads_->pages_prefetched();
    stats.pages_read_ahead = fetch_threads_->pages_read_ahead();
  }
  const storage::SourceStats source = pager_->file().source().stats();
  stats.http_requests = source.requests;
  stats.http_bytes = source.bytes;
  stats.http_cached_bytes = source.cached_bytes;
  stats.http_rounds = source.rounds;
  stats.layers = pager_->opened().layers;
  stats.locked_bytes = pager_->locked_bytes();
  stats.field_damaged = field_damaged_;
  stats.header_copy_damaged = pager_->file().header_copy_damaged();
  return stats;
}

}  // namespace query

Result<Model> Model::open(const std::filesystem::path& path, const OpenOptions& options) {
  return query::ModelState::open_model(path, options);
}

Model::Model(std::unique_ptr<query::ModelState> state) noexcept : state_(std::move(state)) {}
Model::Model(Model&&) noexcept = default;
Model& Model::operator=(Model&&) noexcept = default;
Model::~Model() = default;

const ModelInfo& Model::info() const noexcept { return state_->info(); }
Stats Model::stats() const noexcept { return state_->stats(); }
std::optional<Error> Model::read_error() const noexcept { return state_->read_error(); }
Result<Metadata> Model::metadata() const { return state_->metadata(); }
Result<void> Model::triangles(std::span<const std::uint64_t> indices,
                              std::span<MeshTriangle> triangles) const noexcept {
  return state_->find_triangles(indices, triangles);
}
Result<MeshTriangle> Model::triangle(std::uint64_t index) const noexcept {
  MeshTriangle triangle;
  const auto found = triangles({&index, 1}, {&triangle, 1});
  return found ? Result<MeshTriangle>(triangle) : found.error();
}
std::size_t Model::drain_page_trace(std::span<PageAccess> accesses) const noexcept {
  return state_->drain_page_trace(accesses);
}

}  // namespace planetree
