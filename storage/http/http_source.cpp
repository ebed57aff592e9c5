#include "storage/http/http_source.h"

#include <algorithm>
#include <new>
#include <utility>

#include "storage/http/http_url.h"

namespace planetree::storage {
namespace {

// What libcurl keeps of the connections of one thread, about.
constexpr std::uint64_t kClientBytes = std::uint64_t{512} << 10;

// The requests for the claims that are not loaded: one for those that are neighbours.
class RequestPlan {
 public:
  // claims  in the order of clusters
  explicit RequestPlan(std::span<const ClusterMemory::Claim> claims)
      : request_of_(claims.size(), kLoaded) {
    for (std::size_t i = 0; i < claims.size(); ++i) {
      if (claims[i].is_loaded) continue;
      const bool joins = i > 0 && request_of_[i - 1] != kLoaded &&
                         claims[i - 1].cluster + 1 == claims[i].cluster &&
                         requests.back().parts.size() < HttpSource::kMaxRunClusters;
      if (!joins) requests.emplace_back().offset = claims[i].cluster * kClusterBytes;
      requests.back().parts.push_back(claims[i].bytes);
      request_of_[i] = requests.size() - 1;
    }
  }

  // Marks the claims that have come. Returns the first failure.
  Result<void> finish(std::span<ClusterMemory::Claim> claims) const noexcept {
    Result<void> failure;
    for (std::size_t i = 0; i < claims.size(); ++i) {
      if (!is_new(i)) continue;
      const Result<void>& result = requests[request_of_[i]].result;
      claims[i].is_loaded = static_cast<bool>(result);
      if (!result && failure) failure = result;
    }
    return failure;
  }

  bool is_new(std::size_t claim) const noexcept { return request_of_[claim] != kLoaded; }

  std::vector<RangeRequest> requests;

 private:
  static constexpr std::size_t kLoaded = ~std::size_t{0};
  std::vector<std::size_t> request_of_;  // indexed by claim
};

Error no_memory_to_read() noexcept {
  return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                    "no memory to read from the server; free some and try again");
}

}  // namespace

Result<std::unique_ptr<ByteSource>> HttpSource::open(const std::string& url,
                                                     const HttpOptions& options) {
  try {
    std::unique_ptr<ClusterFile> file;
    if (!options.cache_directory.empty()) {
      auto opened = ClusterFile::open(options.cache_directory, options.cache_bytes);
      if (!opened) return opened.error();
      file = std::move(*opened);
    }
    auto client = std::make_unique<RangeClient>(url, options.limits);
    std::vector<std::byte> head(kHeadBytes);
    auto identity = client->open(head);
    if (!identity) return identity.error();
    // Without a validator, a cluster of an earlier object might be taken for one of this.
    if (!identity->has_validator()) file.reset();
    std::unique_ptr<HttpSource> source(
        new HttpSource(std::move(client), std::move(file), *std::move(identity), options.clusters));
    if (!source->memory_.ok()) return no_memory_to_read();
    head.resize(static_cast<std::size_t>(std::min(source->size_bytes(), kHeadBytes)));
    source->keep_head(head);
    return std::unique_ptr<ByteSource>(std::move(source));
  } catch (const std::bad_alloc&) {
    return no_memory_to_read();
  }
}

HttpSource::HttpSource(std::unique_ptr<RangeClient> client, std::unique_ptr<ClusterFile> file,
                       ObjectIdentity identity, std::size_t clusters)
    : identity_(std::move(identity)),
      key_(identity_.key()),
      name_(shown_url(identity_.url)),
      client_(std::move(client)),
      file_(std::move(file)),
      clusters_(clusters),
      memory_(identity_.size_bytes, clusters) {}

void HttpSource::keep_head(std::span<const std::byte> head) {
  std::vector<std::uint64_t> clusters;
  for (std::uint64_t at = 0; at * kClusterBytes < head.size(); ++at) clusters.push_back(at);
  std::vector<Claim> claims = memory_.claim(clusters);
  for (Claim& claim : claims) {
    const auto bytes =
        head.subspan(static_cast<std::size_t>(claim.cluster * kClusterBytes), claim.bytes.size());
    std::copy(bytes.begin(), bytes.end(), claim.bytes.begin());
    claim.is_loaded = true;
    if (file_) file_->write(key_, claim.cluster, claim.bytes);
  }
  memory_.finish(claims);
}

std::uint64_t HttpSource::memory_bytes() const noexcept {
  return memory_bytes(HttpOptions{.clusters = clusters_});
}

std::uint64_t HttpSource::memory_bytes(const HttpOptions& options) noexcept {
  return options.clusters * kClusterBytes + kClientBytes + sizeof(HttpSource);
}

SourceStats HttpSource::stats() const noexcept {
  return {client_->request_count(), client_->byte_count(),
          cached_bytes_.load(std::memory_order_relaxed), client_->round_count()};
}

bool HttpSource::try_read(std::uint64_t offset, std::span<std::byte> out,
                          const ReadLimits& /*terms*/) const noexcept {
  return memory_.try_copy(offset, out);
}

Result<void> HttpSource::read_at(std::uint64_t offset, std::span<std::byte> out,
                                 const char* /*what*/) const noexcept {
  if (offset > size_bytes() || out.size() > size_bytes() - offset)
    return make_error(ErrorCode::kTruncated, Error::kNowhere, offset,
                      "the file ends too early; restore it from a copy or build it again");
  try {
    while (!out.empty()) {
      const std::size_t count =
          std::min(out.size(), static_cast<std::size_t>(ClusterMemory::kMaxCopyBytes));
      if (const auto read = read_piece(offset, out.first(count)); !read) return read;
      offset += count;
      out = out.subspan(count);
    }
    return {};
  } catch (const std::bad_alloc&) {
    return no_memory_to_read();
  }
}

Result<void> HttpSource::read_piece(std::uint64_t offset, std::span<std::byte> out) const {
  std::vector<Claim> claims;
  for (;;) {
    memory_.copy_or_claim(offset, out, clusters_ahead(offset, out.size()), claims);
    if (claims.empty()) return {};
    if (const auto loaded = load(claims, RangeClient::kNoLimit); !loaded) return loaded;
  }
}

// How many clusters behind those asked for to get with them: more the longer the object has been
// read from front to back.
std::uint64_t HttpSource::clusters_ahead(std::uint64_t offset, std::size_t bytes) const noexcept {
  const std::uint64_t next = run_end_.load(std::memory_order_relaxed);
  if (next < offset / kClusterBytes || next > (offset + bytes - 1) / kClusterBytes) return 0;
  const unsigned length = run_length_.load(std::memory_order_relaxed);
  return length == 0 ? 0 : length == 1 ? 1 : kMaxRunClusters - 1;
}

// Takes from the cluster file what it has.
void HttpSource::read_cached(std::span<Claim> claims) const {
  for (Claim& claim : claims) {
    claim.is_loaded = file_ && file_->read(key_, claim.cluster, claim.bytes);
    if (claim.is_loaded) cached_bytes_.fetch_add(claim.bytes.size(), std::memory_order_relaxed);
  }
}

void HttpSource::note_run(std::span<const Claim> claims) const noexcept {
  const bool follows = claims.front().cluster == run_end_.load(std::memory_order_relaxed);
  const unsigned length = run_length_.load(std::memory_order_relaxed);
  run_length_.store(follows ? length + 1 : 0, std::memory_order_relaxed);
  run_end_.store(claims.back().cluster + 1, std::memory_order_relaxed);
}

// Returns the first failure. Clusters that came in spite of it stay.
Result<void> HttpSource::load(std::span<Claim> claims, std::chrono::milliseconds max_time) const {
  Result<void> loaded;
  try {
    std::sort(claims.begin(), claims.end(),
              [](const Claim& a, const Claim& b) { return a.cluster < b.cluster; });
    note_run(claims);
    read_cached(claims);
    RequestPlan plan(claims);
    if (!plan.requests.empty()) client_->fetch(plan.requests, max_time);
    loaded = plan.finish(claims);
    for (std::size_t i = 0; i < claims.size() && file_; ++i)
      if (plan.is_new(i) && claims[i].is_loaded)
        file_->write(key_, claims[i].cluster, claims[i].bytes);
  } catch (const std::bad_alloc&) {
    memory_.finish(claims);
    throw;
  }
  memory_.finish(claims);
  return loaded;
}

void HttpSource::prefetch(std::span<const ByteRange> ranges) const noexcept {
  prefetch_within(ranges, RangeClient::kNoLimit);
}

void HttpSource::prefetch_within(std::span<const ByteRange> ranges,
                                 std::chrono::milliseconds max_time) const noexcept {
  try {
    std::vector<std::uint64_t> clusters;
    for (const ByteRange& range : ranges) {
      if (range.bytes == 0 || range.offset >= size_bytes()) continue;
      const std::uint64_t last =
          (std::min(range.bytes, size_bytes() - range.offset) + range.offset - 1) / kClusterBytes;
      for (std::uint64_t at = range.offset / kClusterBytes; at <= last; ++at)
        clusters.push_back(at);
    }
    std::sort(clusters.begin(), clusters.end());
    clusters.erase(std::unique(clusters.begin(), clusters.end()), clusters.end());
    std::vector<Claim> claims = memory_.claim(clusters);
    if (!claims.empty()) static_cast<void>(load(claims, max_time));
  } catch (const std::bad_alloc&) {
    return;  // read_at() reports it
  }
}

bool HttpSource::is_here(const ByteRange& range) const noexcept {
  return memory_.has(range.offset, range.bytes);
}

bool HttpSource::forget(const ByteRange& range) const noexcept {
  const std::uint64_t first = range.offset / kClusterBytes;
  const std::uint64_t last =
      (range.offset + std::max<std::uint64_t>(range.bytes, 1) - 1) / kClusterBytes;
  memory_.forget(first, last);
  for (std::uint64_t cluster = first; file_ && cluster <= last; ++cluster)
    file_->forget(key_, cluster);
  return true;
}

}  // namespace planetree::storage
